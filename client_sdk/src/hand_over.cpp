// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/hand_over.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <variant>

#include "client_sdk/hosting/frame_handler.hpp"

namespace cohort {
void HandOver::offer(const ClientEvent& event) {
  Lock lock(mutex_);
  event_ = event;
  descriptor_.set_readable(true);
  changed_.notify_all();
  changed_.wait(lock, [&] { return !event_ || left_; });
  if (event_) throw LeaveRun{};
  if (failure_) throw ControllerFailure(*std::exchange(failure_, std::nullopt));
  if (std::exchange(unanswered_, false)) throw NoAnswer{};
}

void HandOver::end(ClientEnded ended) {
  const Lock lock(mutex_);
  event_.reset();
  taken_ = false;
  ended_ = std::move(ended);
  descriptor_.set_readable(true);
  changed_.notify_all();
}

std::optional<ClientEvent> HandOver::take(std::optional<std::chrono::steady_clock::time_point> deadline) {
  Lock lock(mutex_);
  const auto is_there = [&] { return (event_ && !taken_) || ended_; };
  if (deadline && !changed_.wait_until(lock, *deadline, is_there)) return std::nullopt;
  if (!deadline) changed_.wait(lock, is_there);
  if (ended_) return *ended_;
  taken_ = true;
  descriptor_.set_readable(false);
  return event_;
}

void HandOver::answer() {
  const Lock lock(mutex_);
  if (!std::exchange(taken_, false)) return;
  event_.reset();
  changed_.notify_all();
}

void HandOver::leave_unanswered() {
  const Lock lock(mutex_);
  const auto* frame = taken_ ? std::get_if<Frame>(&*event_) : nullptr;
  if (frame == nullptr) throw std::logic_error("leave_unanswered: no frame has been received that needs an answer");
  if (std::ranges::any_of(frame->robots, [](const FrameRobot& robot) { return robot.robot->policy.waits; }))
    throw std::logic_error(
        "leave_unanswered: the frame has robots of a team in lockstep, for which an answer is required");
  taken_ = false;
  unanswered_ = true;
  event_.reset();
  changed_.notify_all();
}

void HandOver::fail(const std::string& why) {
  const Lock lock(mutex_);
  if (!std::exchange(taken_, false)) return;
  event_.reset();
  failure_ = why;
  changed_.notify_all();
}

void HandOver::leave() {
  const Lock lock(mutex_);
  left_ = true;
  changed_.notify_all();
}

}  // namespace cohort
