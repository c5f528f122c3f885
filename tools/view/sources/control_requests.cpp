// SPDX-License-Identifier: Apache-2.0
#include "tools/view/sources/control_requests.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace cohort::view {
namespace {

using wire::Operation;
using wire::SimulationState;

wire::Vector3 vector_in(const ViewRequest& asked) {
  if (asked.numbers.size() < 2 || asked.numbers.size() > 3)
    throw std::invalid_argument("'" + asked.operation + "' expects x, y and optionally z");
  return {asked.numbers[0], asked.numbers[1], asked.numbers.size() > 2 ? asked.numbers[2] : 0.0};
}

// Upright, with its heading about the vertical.
wire::Pose pose_in(const ViewRequest& asked) {
  if (asked.numbers.size() < 2 || asked.numbers.size() > 4)
    throw std::invalid_argument("'" + asked.operation + "' expects x, y, optionally z, and optionally a heading");
  std::array<double, 4> numbers{};
  std::ranges::copy(asked.numbers, numbers.begin());
  wire::Pose pose;
  pose.position = {numbers[0], numbers[1], numbers[2]};
  pose.orientation = {0.0, 0.0, std::sin(0.5 * numbers[3]), std::cos(0.5 * numbers[3])};
  return pose;
}

const std::string& object_in(const ViewRequest& asked) {
  if (asked.name.empty()) throw std::invalid_argument("'" + asked.operation + "' needs the name of an object");
  return asked.name;
}

template <wire::SimulationState state>
Operation to_state(const ViewRequest&) {
  return wire::SetSimulationState{state};
}

Operation reset(const ViewRequest&) { return wire::ResetSimulation{}; }

Operation step(const ViewRequest& asked) {
  constexpr double most = 1e9;
  if (!(asked.number >= 1.0 && asked.number <= most))
    throw std::invalid_argument("expected a step of one tick or more");
  return wire::StepSimulation{static_cast<std::uint64_t>(asked.number)};
}

Operation speed(const ViewRequest& asked) {
  if (!(asked.number >= 0.0) || !std::isfinite(asked.number))
    throw std::invalid_argument("expected a speed above 0, or 0 for as fast as possible");
  return wire::SetSpeed{asked.number};
}

Operation spawn(const ViewRequest& asked) {
  return wire::SpawnEntity{.entity = object_in(asked), .uri = asked.text, .pose = pose_in(asked)};
}

Operation remove(const ViewRequest& asked) { return wire::DeleteEntity{object_in(asked)}; }

Operation move(const ViewRequest& asked) {
  return wire::SetEntityState{.entity = object_in(asked), .pose = pose_in(asked)};
}

Operation light(const ViewRequest& asked) {
  return wire::SetLight{.entity = object_in(asked), .on = asked.number != 0.0};
}

Operation push(const ViewRequest& asked) {
  constexpr std::int64_t tenth_of_a_second = 100'000'000;
  return wire::ApplyForce{.entity = object_in(asked), .force = vector_in(asked), .duration_ns = tenth_of_a_second};
}

struct ViewOperation {
  const char* name;
  Operation (*operation)(const ViewRequest&);
};
constexpr std::array view_operations = {
    ViewOperation{"play", to_state<SimulationState::playing>},
    ViewOperation{"pause", to_state<SimulationState::paused>},
    ViewOperation{"step", step},
    ViewOperation{"speed", speed},
    ViewOperation{"reset", reset},
    ViewOperation{"spawn", spawn},
    ViewOperation{"remove", remove},
    ViewOperation{"move", move},
    ViewOperation{"light", light},
    ViewOperation{"push", push},
    ViewOperation{"shutdown", to_state<SimulationState::quitting>},
};

}  // namespace

Operation operation_of(const ViewRequest& asked) {
  const auto* const found =
      std::ranges::find_if(view_operations, [&](const ViewOperation& each) { return asked.operation == each.name; });
  if (found == view_operations.end()) throw std::invalid_argument("'" + asked.operation + "': unknown operation");
  return found->operation(asked);
}

}  // namespace cohort::view
