// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cohort.h"

/// The state of controllers (docs/protocol.md, "State of controllers").
namespace cohort::conformance {

namespace message = ::cohort::v1;

struct RobotState {
  std::uint32_t robot = 0;
  bool is_saved = false;
  std::string name{};
  std::vector<std::byte> bytes{};
};

std::vector<std::uint8_t> pack(const std::vector<RobotState>& states);
/// Unpacks states; throws std::runtime_error if the format is invalid.
std::vector<RobotState> unpack(const std::vector<std::uint8_t>& bytes);

/// Returns the part of `bytes` that answers `wanted`.
message::ControllerState part_of(const std::vector<std::uint8_t>& bytes, const message::ControllerState& wanted);

/// State that is fetched in parts.
class FetchedState {
 public:
  explicit FetchedState(const message::Admit& admit) : admit_(admit) {}

  /// Returns the request that is due now, if any.
  std::optional<message::ControllerState> question(std::chrono::steady_clock::time_point now);
  void take(const message::ControllerState& part);
  bool is_complete() const { return size_ && bytes_.size() == *size_; }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  message::Admit admit_;
  std::vector<std::uint8_t> bytes_;
  std::optional<std::uint64_t> size_;
  std::optional<std::chrono::steady_clock::time_point> asked_at_;
};

}  // namespace cohort::conformance
