// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/hosting/controller_state.hpp"

#include "idl/text/printable.hpp"

namespace cohort {

std::vector<std::byte> pack(std::span<const RobotState> states) {
  StateWriter writer;
  for (const auto& [robot, state] : states) {
    writer.write(robot, state.has_value());
    if (state) writer.write(printable(state->controller, longest_controller_name), state->bytes);
  }
  return {writer.bytes().begin(), writer.bytes().end()};
}

std::vector<RobotState> unpack(std::span<const std::byte> bytes) {
  std::vector<RobotState> states;
  for (StateReader reader(bytes); !reader.rest().empty();) {
    RobotState each;
    bool is_saved = false;
    reader.read(each.robot, is_saved);
    if (!states.empty() && each.robot <= states.back().robot)
      throw StateError("invalid controller state: robot ids are not in ascending order");
    if (is_saved) {
      ControllerState& state = each.state.emplace();
      reader.read(state.controller, state.bytes);
      if (state.controller.size() > longest_controller_name || state.bytes.size() > largest_state)
        throw StateError("invalid controller state: the state of a robot is too large");
    }
    states.push_back(std::move(each));
  }
  return states;
}

std::size_t largest_packed(std::size_t robots) {
  constexpr std::size_t besides = 32;  // id, flag and two sizes
  return robots * (besides + longest_controller_name + largest_state);
}

}  // namespace cohort
