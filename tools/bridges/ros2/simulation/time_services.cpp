// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/simulation/time_services.hpp"

#include <algorithm>
#include <utility>

#include "tools/bridges/ros2/simulation/service_results.hpp"

namespace cohort::ros2 {
namespace {

using simulation::Result;
using simulation::SimulatorFeatures;

// Features of the bridge itself, beside those that the server reports.
constexpr std::array own_features = {SimulatorFeatures::entity_categories, SimulatorFeatures::entity_info_getting,
                                     SimulatorFeatures::spawnables, SimulatorFeatures::world_info_getting,
                                     SimulatorFeatures::spawning_entities};

constexpr const char* one_experiment = "a server runs one experiment; start another server with 'cohort serve'";

ControlReply set_state(Control& run, SimulationState state) {
  switch (state) {
    case SimulationState::stopped: return run.stop();
    case SimulationState::playing: return run.play();
    case SimulationState::paused: return run.pause();
    case SimulationState::quitting: break;
  }
  return run.quit();
}

}  // namespace

simulation::GetSimulatorFeatures::Response answer(Control& run, const simulation::GetSimulatorFeatures::Request&) {
  simulation::GetSimulatorFeatures::Response response;
  auto& [features, spawn_formats, custom_info] = response.features;
  try {
    auto supported = run.features();
    for (const std::uint32_t feature : supported.features) features.push_back(static_cast<std::uint16_t>(feature));
    features.insert(features.end(), own_features.begin(), own_features.end());
    std::ranges::sort(features);
    spawn_formats = std::move(supported.spawn_formats);
    custom_info = "Cohort";
  } catch (const ControlError& error) {
    custom_info = result_of(error).error_message;
  }
  return response;
}

simulation::GetSimulationState::Response answer(Control& run, const simulation::GetSimulationState::Request&) {
  const SimulationState state = run.state();
  return {{static_cast<std::uint8_t>(state)}, result_of(run.last_reply())};
}

simulation::SetSimulationState::Response answer(Control& run, const simulation::SetSimulationState::Request& asked) {
  const auto state = static_cast<SimulationState>(asked.state.state);
  if (state > SimulationState::quitting)
    return {{Result::feature_unsupported, "state " + std::to_string(asked.state.state) +
                                              ": expected 0 (stopped), 1 (playing), 2 (paused) or 3 (quitting)"}};
  const ControlReply reply = set_state(run, state);
  if (reply.was_in_state) return {{simulation::SetSimulationState::Response::already_in_target_state, reply.message}};
  return {result_of(reply)};
}

simulation::StepSimulation::Response answer(Control& run, const simulation::StepSimulation::Request& asked) {
  return {result_of(run.step(asked.steps))};
}

simulation::ResetSimulation::Response answer(Control& run, const simulation::ResetSimulation::Request& asked) {
  return {result_of(run.reset({}, static_cast<ResetScope>(asked.scope)))};
}

simulation::LoadWorld::Response answer(Control&, const simulation::LoadWorld::Request&) {
  return {{Result::feature_unsupported, one_experiment}, {}};
}
simulation::UnloadWorld::Response answer(Control&, const simulation::UnloadWorld::Request&) {
  return {{Result::feature_unsupported, one_experiment}};
}
simulation::GetAvailableWorlds::Response answer(Control&, const simulation::GetAvailableWorlds::Request&) {
  return {{Result::feature_unsupported, one_experiment}, {}};
}

}  // namespace cohort::ros2
