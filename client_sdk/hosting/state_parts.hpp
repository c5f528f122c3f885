#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "idl/wire/messages.hpp"

namespace cohort {

/// State that comes in parts which are asked for one by one: docs/protocol.md, "State of controllers". Pure logic, with
/// the caller's clock. Not thread-safe.
class StateParts {
 public:
  using Time = std::chrono::nanoseconds;

  /// Begins anew: of all, at most `most` bytes.
  void begin(std::size_t most, Time now);
  /// Whether the next part has to be asked for, again if it was before.
  bool is_due(Time now) const { return !is_complete() && now >= ask_at_; }
  void note_question(Time now);
  /// Where the next part begins.
  std::uint64_t offset() const { return bytes_.size(); }
  /// False of a part that is not the next one: it has come before. Throws StateError if it cannot be a part of this.
  bool take(std::span<const std::uint8_t> data, std::uint64_t offset, std::uint64_t size, Time now);

  bool is_complete() const { return is_complete_; }
  /// When the last part came, or this began.
  Time heard_at() const { return heard_at_; }
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t most_ = 0;
  std::uint64_t size_ = 0;  // of all, once the first part is there
  bool is_complete_ = false;
  Time heard_at_{0};
  Time ask_at_{0};
  Time interval_{0};
};

/// The part of `bytes` from `offset` on that one message takes; its head is up to the caller.
wire::ControllerState part_of(std::span<const std::byte> bytes, std::uint64_t offset);

/// What came of ControllerState, for later.
struct KeptStateMessage {
  explicit KeptStateMessage(const wire::ControllerState& message)
      : head(message), data(message.data.begin(), message.data.end()) {
    head.data = {};
  }
  wire::ControllerState head;  ///< without its data
  std::vector<std::uint8_t> data;
};

}  // namespace cohort
