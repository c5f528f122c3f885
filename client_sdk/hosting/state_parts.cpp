// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/hosting/state_parts.hpp"

#include <algorithm>
#include <string>

#include "client_sdk/include/cohort/state.hpp"

namespace cohort {
namespace {

using namespace std::chrono_literals;

constexpr auto first_interval = 20ms;
constexpr auto longest_interval = 500ms;

}  // namespace

void StateParts::begin(std::size_t most, Time now) {
  *this = StateParts();
  most_ = most;
  heard_at_ = ask_at_ = now;
  interval_ = first_interval;
}

void StateParts::note_question(Time now) {
  ask_at_ = now + interval_;
  interval_ = std::min<Time>(2 * interval_, longest_interval);
}

bool StateParts::take(std::span<const std::uint8_t> data, std::uint64_t offset, std::uint64_t size, Time now) {
  if (is_complete_ || offset != bytes_.size()) return false;
  if (offset == 0) size_ = size;
  if (size_ != size || size > most_ || data.size() > size - offset || (data.empty() && offset != size))
    throw StateError("invalid part of a controller state: " + std::to_string(data.size()) + " bytes at offset " +
                     std::to_string(offset) + " of " + std::to_string(size) + " bytes, at most " +
                     std::to_string(most_) + " in total");
  const auto part = std::as_bytes(data);
  bytes_.insert(bytes_.end(), part.begin(), part.end());
  is_complete_ = bytes_.size() == size_;
  heard_at_ = ask_at_ = now;
  interval_ = first_interval;
  return true;
}

wire::ControllerState part_of(std::span<const std::byte> bytes, std::uint64_t offset) {
  const std::size_t from = std::min<std::uint64_t>(offset, bytes.size());
  const auto part = bytes.subspan(from, std::min(bytes.size() - from, wire::largest_state_part));
  wire::ControllerState message;
  message.kind = wire::StateKind::here;
  message.size = bytes.size();
  message.offset = from;
  message.data = {reinterpret_cast<const std::uint8_t*>(part.data()), part.size()};
  return message;
}

}  // namespace cohort
