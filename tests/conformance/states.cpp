// SPDX-License-Identifier: Apache-2.0
#include "tests/conformance/states.hpp"

#include <algorithm>
#include <cohort/state.hpp>
#include <stdexcept>

namespace cohort::conformance {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t largest_part = 262144;
constexpr std::size_t longest_name = 256;
constexpr auto asked_again_after = 20ms;
enum Kind : std::uint32_t { wanted_kind = 0, here_kind = 1 };

}  // namespace

std::vector<std::uint8_t> pack(const std::vector<RobotState>& states) {
  StateWriter writer;
  for (const RobotState& state : states) {
    writer.write(state.robot, state.is_saved);
    if (state.is_saved) writer.write(std::string_view(state.name), state.bytes);
  }
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(writer.bytes().data());
  return {bytes, bytes + writer.bytes().size()};
}

std::vector<RobotState> unpack(const std::vector<std::uint8_t>& bytes) {
  std::vector<RobotState> states;
  for (StateReader reader(std::as_bytes(std::span(bytes))); !reader.rest().empty();) {
    RobotState& state = states.emplace_back();
    reader.read(state.robot, state.is_saved);
    if (state.is_saved) reader.read(state.name, state.bytes);
    if (state.name.size() > longest_name || state.bytes.size() > largest_state)
      throw std::runtime_error("the state of a robot is larger than the page allows");
  }
  if (!std::ranges::is_sorted(states, std::less<>(), &RobotState::robot))
    throw std::runtime_error("the ids of the state's robots do not ascend");
  return states;
}

message::ControllerState part_of(const std::vector<std::uint8_t>& bytes, const message::ControllerState& wanted) {
  message::ControllerState part = wanted;
  part.kind(here_kind);
  part.size(bytes.size());
  const std::size_t begin = std::min<std::size_t>(wanted.offset(), bytes.size());
  const std::size_t end = std::min(begin + largest_part, bytes.size());
  part.offset(begin);
  part.data().assign(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                     bytes.begin() + static_cast<std::ptrdiff_t>(end));
  return part;
}

std::optional<message::ControllerState> FetchedState::question(std::chrono::steady_clock::time_point now) {
  if (is_complete() || (asked_at_ && now - *asked_at_ < asked_again_after)) return std::nullopt;
  asked_at_ = now;
  message::ControllerState question;
  question.client(admit_.client());
  question.run(admit_.run());
  question.kind(wanted_kind);
  question.epoch(admit_.epoch());
  question.tick(admit_.tick());
  question.offset(bytes_.size());
  return question;
}

void FetchedState::take(const message::ControllerState& part) {
  const bool is_mine = part.kind() == here_kind && part.run() == admit_.run() && part.epoch() == admit_.epoch() &&
                       part.tick() == admit_.tick() && part.offset() == bytes_.size();
  if (!is_mine || is_complete()) return;
  size_ = part.size();
  bytes_.insert(bytes_.end(), part.data().begin(), part.data().end());
  if (bytes_.size() > *size_) throw std::runtime_error("more state has come than the server said");
  asked_at_.reset();  // the next part is due at once
}

}  // namespace cohort::conformance
