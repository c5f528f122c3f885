// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/include/cohort/state.hpp"

namespace cohort {

/// The state of a robot's controller at some tick, written by `save`.
struct ControllerState {
  std::string controller;  ///< name of its kind; other kinds cannot read the bytes
  std::vector<std::byte> bytes;
  bool operator==(const ControllerState&) const = default;
};

/// The state of a robot; empty if its controller does not save.
struct RobotState {
  std::uint32_t robot = 0;
  std::optional<ControllerState> state{};
  bool operator==(const RobotState&) const = default;
};

/// Maximum length of the name of a kind of controllers [bytes].
inline constexpr std::size_t longest_controller_name = 256;

/// Returns the states in their format on the network: docs/protocol.md, "State of controllers".
std::vector<std::byte> pack(std::span<const RobotState> states);
/// Parses states. Throws StateError unless robots are in ascending order and no size exceeds its limit.
std::vector<RobotState> unpack(std::span<const std::byte> bytes);
/// Returns the maximum size of `pack` for a number of robots [bytes].
std::size_t largest_packed(std::size_t robots);

}  // namespace cohort
