// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/simulation/time_services.hpp"

#include <algorithm>

namespace cohort::ros2 {
namespace {

using simulation::Result;
using simulation::SimulatorFeatures;

// Features of the bridge itself, beside those that the server reports.
constexpr std::array own_features = {SimulatorFeatures::entity_categories, SimulatorFeatures::entity_info_getting,
                                     SimulatorFeatures::spawnables, SimulatorFeatures::world_info_getting,
                                     SimulatorFeatures::spawning_entities};

constexpr const char* one_experiment = "a server runs one experiment; start another server with 'cohort serve'";

}  // namespace

simulation::GetSimulatorFeatures::Response answer(RunControl& run, const simulation::GetSimulatorFeatures::Request&) {
  const wire::Reply reply = run.ask(wire::GetSimulatorFeatures{});
  simulation::GetSimulatorFeatures::Response response;
  auto& [features, spawn_formats, custom_info] = response.features;
  if (const auto* has = reply.get<wire::SimulatorFeatures>()) {
    for (const std::uint32_t feature : has->features) features.push_back(static_cast<std::uint16_t>(feature));
    features.insert(features.end(), own_features.begin(), own_features.end());
    std::ranges::sort(features);
    spawn_formats = has->spawn_formats;
    custom_info = "Cohort";
  } else {
    custom_info = reply.error_message;
  }
  return response;
}

simulation::GetSimulationState::Response answer(RunControl& run, const simulation::GetSimulationState::Request&) {
  const wire::Reply reply = run.ask(wire::GetSimulationState{});
  return {{static_cast<std::uint8_t>(reply.state)}, result_of(reply)};
}

simulation::SetSimulationState::Response answer(RunControl& run, const simulation::SetSimulationState::Request& asked) {
  const auto state = static_cast<SimulationState>(asked.state.state);
  if (state > SimulationState::quitting)
    return {{Result::feature_unsupported, "state " + std::to_string(asked.state.state) +
                                              ": expected 0 (stopped), 1 (playing), 2 (paused) or 3 (quitting)"}};
  const bool takes_long = state == SimulationState::stopped;
  const wire::Reply reply =
      run.ask(wire::SetSimulationState{state}, takes_long ? RunControl::no_limit : RunControl::usual_limit);
  // It may have gone before its reply has come.
  if (!reply.is_done() && state == SimulationState::quitting && run.server_is_gone())
    return {{Result::ok, "the server has ended"}};
  return {result_of(reply)};
}

simulation::StepSimulation::Response answer(RunControl& run, const simulation::StepSimulation::Request& asked) {
  return {result_of(run.ask(wire::StepSimulation{asked.steps}, RunControl::no_limit))};
}

simulation::ResetSimulation::Response answer(RunControl& run, const simulation::ResetSimulation::Request& asked) {
  return {result_of(run.ask(wire::ResetSimulation{asked.scope, {}}, RunControl::no_limit))};
}

simulation::LoadWorld::Response answer(RunControl&, const simulation::LoadWorld::Request&) {
  return {{Result::feature_unsupported, one_experiment}, {}};
}
simulation::UnloadWorld::Response answer(RunControl&, const simulation::UnloadWorld::Request&) {
  return {{Result::feature_unsupported, one_experiment}};
}
simulation::GetAvailableWorlds::Response answer(RunControl&, const simulation::GetAvailableWorlds::Request&) {
  return {{Result::feature_unsupported, one_experiment}, {}};
}

}  // namespace cohort::ros2
