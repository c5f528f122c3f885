#include "client_sdk/src/hand_over.hpp"

#include <utility>

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
