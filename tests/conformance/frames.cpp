// SPDX-License-Identifier: Apache-2.0
#include "tests/conformance/frames.hpp"

#include <algorithm>

namespace cohort::conformance {
namespace {

constexpr std::size_t most_waiting = 64;
constexpr std::size_t fewest_answers_kept = 8;
constexpr int most_repeats_without_the_earlier_one = 8;

}  // namespace

Frames::Frames(const message::Admit& admit) : epoch_(admit.epoch()), next_tick_(admit.tick()), robots_(admit.robots()) {
  for (const message::AdmittedRobot& robot : robots_) {
    longest_delay_ = std::max<std::uint64_t>(longest_delay_, robot.delay());
  }
}

Frames::Kind Frames::kind_of(const message::Observation& frame) const {
  if (frame.epoch() == epoch_) return Kind::of_the_lease;
  return frame.epoch() < epoch_ ? Kind::of_an_earlier_one : Kind::of_a_later_one;
}

const message::Command* Frames::arrive(message::Observation frame) {
  const std::uint64_t tick = frame.tick();
  highest_ = std::max(highest_, tick);
  if (tick < next_tick_) {
    const auto answer = std::ranges::find(answers_, tick, [](const message::Command& kept) { return kept.tick(); });
    return answer == answers_.end() ? nullptr : &*answer;
  }
  if (const auto known = waiting_.find(tick); known != waiting_.end()) {
    ++known->second.came_again;
  } else if (waiting_.size() < most_waiting) {
    waiting_.emplace(tick, Waiting{std::move(frame)});
  }
  return nullptr;
}

std::optional<message::Observation> Frames::next() {
  if (waiting_.empty()) return std::nullopt;
  const auto first = waiting_.begin();
  const bool patience_is_over = first->second.came_again >= most_repeats_without_the_earlier_one;
  if (!patience_is_over && misses_an_earlier_one(first->first)) return std::nullopt;
  message::Observation frame = std::move(first->second.frame);
  next_tick_ = first->first + 1;
  waiting_.erase(first);
  return frame;
}

void Frames::keep(const message::Command& answer) {
  answers_.push_back(answer);
  if (answers_.size() > std::max<std::size_t>(fewest_answers_kept, longest_delay_ + 1)) answers_.pop_front();
}

bool Frames::is_due(std::uint64_t tick) const {
  return std::ranges::any_of(robots_, [&](const message::AdmittedRobot& robot) {
    return tick >= robot.phase() && (tick - robot.phase()) % robot.period() == 0;
  });
}

bool Frames::misses_an_earlier_one(std::uint64_t tick) const {
  const std::uint64_t oldest_awaited = highest_ - std::min(highest_, longest_delay_);
  for (std::uint64_t earlier = std::max(next_tick_, oldest_awaited); earlier < tick; ++earlier) {
    if (is_due(earlier)) return true;
  }
  return false;
}

}  // namespace cohort::conformance
