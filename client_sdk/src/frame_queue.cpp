// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/frame_queue.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace cohort {
namespace {

// Further frames are dropped: the server sends unanswered frames again.
constexpr std::size_t most_waiting = 64;
constexpr std::size_t fewest_answers_kept = 8;
// Number of repetitions of a frame after which the awaited earlier frame is given up: the server has its answer from a
// previous holder of the lease.
constexpr int patience = 8;

}  // namespace

void FrameQueue::begin(const wire::Admit& admit) {
  run_ = admit.run;
  client_ = admit.client;
  next_tick_ = admit.tick;
  take_schedules(admit);
  answers_kept_ = std::max<std::size_t>(fewest_answers_kept, longest_delay_ + 1);
  answers_.clear();
  oldest_answer_ = 0;
  repeats_.clear();
  drop_waiting_before();
}

void FrameQueue::extend(const wire::Admit& admit) {
  take_schedules(admit);
  // The ring can grow after its newest answer.
  std::rotate(answers_.begin(), answers_.begin() + static_cast<std::ptrdiff_t>(oldest_answer_ % answers_kept_),
              answers_.end());
  answers_kept_ = std::max<std::size_t>(answers_kept_, longest_delay_ + 1);
  oldest_answer_ = answers_.size() % answers_kept_;
  drop_waiting_before();
}

void FrameQueue::take_schedules(const wire::Admit& admit) {
  epoch_ = admit.epoch;
  longest_delay_ = 0;
  newest_only_ = std::ranges::all_of(admit.robots, [](auto& robot) { return robot.mode == wire::Mode::free; });
  schedules_.clear();
  for (const wire::AdmittedRobot& robot : admit.robots) {
    longest_delay_ = std::max<std::uint64_t>(longest_delay_, robot.delay);
    const std::uint64_t period = std::max<std::uint64_t>(robot.period, 1);
    const Schedule schedule{period, robot.phase % period};
    if (std::find(schedules_.begin(), schedules_.end(), schedule) == schedules_.end()) schedules_.push_back(schedule);
  }
}

// Drops frames that are answered, or of earlier leases.
void FrameQueue::drop_waiting_before() {
  std::erase_if(waiting_, [&](const Frame& frame) {
    const wire::Observation& head = frame.head;
    return head.epoch < epoch_ || (head.epoch == epoch_ && head.tick < next_tick_);
  });
}

void FrameQueue::arrive(const wire::Observation& frame) {
  if (epoch_ && frame.epoch < epoch_) return;
  if (epoch_ && frame.epoch == epoch_ && frame.tick < next_tick_) {
    const bool asked = std::ranges::any_of(repeats_, [&](const Repeat& repeat) { return repeat.tick == frame.tick; });
    if (!asked && find_answer(frame.tick) != nullptr) repeats_.push_back({frame.tick, frame.resent});
    return;
  }
  const auto key = [](const wire::Observation& head) { return std::pair(head.epoch, head.tick); };
  const auto place = std::lower_bound(waiting_.begin(), waiting_.end(), key(frame),
                                      [&](const Frame& other, auto wanted) { return key(other.head) < wanted; });
  if (place != waiting_.end() && key(place->head) == key(frame)) {
    ++place->came_again;
    return;
  }
  if (waiting_.size() == most_waiting) return;

  Frame kept;
  if (!spare_.empty()) {
    kept = std::move(spare_.back());
    spare_.pop_back();
  }
  kept.robots.assign(frame.robots.begin(), frame.robots.end());
  kept.values.assign(frame.values.begin(), frame.values.end());
  kept.head = frame;
  kept.head.robots = kept.robots;
  kept.head.values = kept.values;
  kept.came_again = 0;
  waiting_.insert(place, std::move(kept));
}

const wire::Observation* FrameQueue::next() {
  if (!epoch_ || waiting_.empty()) return nullptr;
  if (newest_only_) drop_older();
  Frame& first = waiting_.front();
  if (first.head.epoch != epoch_ || !in_order(first)) return nullptr;
  next_tick_ = first.head.tick + 1;
  under_way_ = std::move(first);
  waiting_.erase(waiting_.begin());
  return &under_way_.head;
}

// Drops all frames of this lease except the last.
void FrameQueue::drop_older() {
  const auto end =
      std::find_if(waiting_.begin(), waiting_.end(), [&](const Frame& frame) { return frame.head.epoch != epoch_; });
  if (end - waiting_.begin() < 2) return;
  std::move(waiting_.begin(), end - 1, std::back_inserter(spare_));
  waiting_.erase(waiting_.begin(), end - 1);
}

wire::Command FrameQueue::finish(std::span<const double> values) {
  if (answers_.size() < answers_kept_) {
    answers_.emplace_back();
    oldest_answer_ = answers_.size() - 1;
  }
  Answer& answer = answers_[oldest_answer_];
  oldest_answer_ = (oldest_answer_ + 1) % answers_kept_;
  answer.tick = under_way_.head.tick;
  answer.resent = under_way_.head.resent;
  answer.values.assign(values.begin(), values.end());
  std::swap(answer.robots, under_way_.robots);
  spare_.push_back(std::move(under_way_));
  return command_of(answer);
}

std::optional<wire::Command> FrameQueue::next_repeat() {
  while (!repeats_.empty()) {
    const Repeat repeat = repeats_.back();
    repeats_.pop_back();
    const Answer* answer = find_answer(repeat.tick);
    if (answer == nullptr) continue;
    wire::Command command = command_of(*answer);
    command.resent = repeat.resent;
    return command;
  }
  return std::nullopt;
}

const FrameQueue::Answer* FrameQueue::find_answer(std::uint64_t tick) const {
  const auto found =
      std::find_if(answers_.begin(), answers_.end(), [&](const Answer& answer) { return answer.tick == tick; });
  return found != answers_.end() ? &*found : nullptr;
}

// Returns true if the frame is the next one. An earlier due tick may still arrive, if it was lost and the server can
// still use its answer. While the newest frame is out, the server waits for the answers of the `delay` ticks before it;
// it has received or given up older ones.
bool FrameQueue::in_order(const Frame& frame) const {
  if (newest_only_) return true;
  if (frame.came_again >= patience) return true;
  std::uint64_t newest = frame.head.tick;
  for (const Frame& other : waiting_) {
    if (other.head.epoch == epoch_) newest = std::max(newest, other.head.tick);
  }
  const std::uint64_t oldest_wanted = newest - std::min(newest, longest_delay_);
  return next_due(std::max(next_tick_, oldest_wanted)) >= frame.head.tick;
}

std::uint64_t FrameQueue::next_due(std::uint64_t tick) const {
  std::uint64_t earliest = ~std::uint64_t{0};
  for (const Schedule& schedule : schedules_) {
    const std::uint64_t since_last = (tick % schedule.period + schedule.period - schedule.phase) % schedule.period;
    earliest = std::min(earliest, since_last == 0 ? tick : tick + schedule.period - since_last);
  }
  return earliest;
}

wire::Command FrameQueue::command_of(const Answer& answer) const {
  return {client_, run_, *epoch_, answer.tick, answer.robots, answer.values, answer.resent};
}

}  // namespace cohort
