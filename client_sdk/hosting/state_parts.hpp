// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "idl/wire/messages.hpp"

namespace cohort {

/// State that arrives in parts, which are requested one by one: docs/protocol.md, "State of controllers". Pure logic,
/// with the caller's clock. Not thread-safe.
class StateParts {
 public:
  using Time = std::chrono::nanoseconds;

  /// Starts a new transfer of at most `most` bytes in total.
  void begin(std::size_t most, Time now);
  /// Returns true if the next part must be requested, or requested again.
  bool is_due(Time now) const { return !is_complete() && now >= ask_at_; }
  void note_question(Time now);
  /// Returns the offset of the next part.
  std::uint64_t offset() const { return bytes_.size(); }
  /// Adds a part. Returns false if it is not the next one, because it has arrived before. Throws StateError if it is
  /// invalid.
  bool take(std::span<const std::uint8_t> data, std::uint64_t offset, std::uint64_t size, Time now);

  bool is_complete() const { return is_complete_; }
  /// Returns the time at which the last part arrived, or the transfer started.
  Time heard_at() const { return heard_at_; }
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t most_ = 0;
  std::uint64_t size_ = 0;  // total size, once the first part has arrived
  bool is_complete_ = false;
  Time heard_at_{0};
  Time ask_at_{0};
  Time interval_{0};
};

/// Returns a message with as many of `bytes` from `offset` on as fit into it; the caller fills in the other members.
wire::ControllerState part_of(std::span<const std::byte> bytes, std::uint64_t offset);

/// A copy of a received ControllerState.
struct KeptStateMessage {
  explicit KeptStateMessage(const wire::ControllerState& message)
      : head(message), data(message.data.begin(), message.data.end()) {
    head.data = {};
  }
  wire::ControllerState head;  ///< without its data
  std::vector<std::uint8_t> data;
};

}  // namespace cohort
