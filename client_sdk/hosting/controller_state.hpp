#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/include/cohort/state.hpp"

namespace cohort {

/// What a robot's controller remembered at some tick, as its `save` wrote it.
struct ControllerState {
  std::string controller;  ///< its kind's name: no other kind can make anything of the bytes
  std::vector<std::byte> bytes;
  bool operator==(const ControllerState&) const = default;
};

/// The same with its robot. Nothing of a controller that does not save.
struct RobotState {
  std::uint32_t robot = 0;
  std::optional<ControllerState> state{};
  bool operator==(const RobotState&) const = default;
};

/// The longest name of a kind of controllers [bytes].
inline constexpr std::size_t longest_controller_name = 256;

/// As they travel: docs/protocol.md, "State of controllers".
std::vector<std::byte> pack(std::span<const RobotState> states);
/// Throws StateError if they are not just that: robots ascending, and nothing larger than it may be.
std::vector<RobotState> unpack(std::span<const std::byte> bytes);
/// The most that `pack` gives of so many robots [bytes].
std::size_t largest_packed(std::size_t robots);

}  // namespace cohort
