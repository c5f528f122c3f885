#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cohort::lockstep {

/// How long one client's answers take: the last 31, from the copy of the frame that reached it to its answer.
class RoundTrips {
 public:
  using Time = std::chrono::nanoseconds;

  void add(Time duration) {
    values_[next_++ % values_.size()] = duration;
    count_ = std::min(count_ + 1, values_.size());
  }
  /// Zero before the first.
  Time median() const {
    if (count_ == 0) return Time{0};
    auto sorted = values_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
    std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(count_));
    return *middle;
  }

 private:
  std::array<Time, 31> values_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

/// When to send a client its unanswered frames again: after max(2 ms, 3 times its usual round trip), then at intervals
/// that grow by an eighth each, to 0.5 s. Slowly: where a fifth of the packets is lost, a message of several packets may
/// need ten tries, and a client that is gone costs some 50 of them. DDS's own repair of a lost sample takes 100 ms and
/// more, since nothing follows it in lockstep.
class ResendTimer {
 public:
  using Time = std::chrono::nanoseconds;

  /// What is known of the client's last answer; counts if it is to the frame last started. An answer names the copy that
  /// it is to, so that what was lost before does not seem to be the client's slowness.
  void note_answer(std::uint64_t tick, std::uint32_t copy, Time answered_at) {
    if (tick != tick_ || copy >= sent_at_.size() || answered_at <= sent_at_[copy]) return;
    round_trips_.add(answered_at - sent_at_[copy]);
    sent_at_.clear();
  }
  /// The frame of `tick` is sent for the first time.
  void start(std::uint64_t tick, Time now) {
    tick_ = tick;
    sent_at_.assign(1, now);
    interval_ = Time{0};  // found out when it matters: most answers are there before
    due_ = now + shortest;
  }
  /// When `is_due` is worth a look.
  Time due() const { return due_; }
  bool is_due(Time now) {
    if (now < due_) return false;
    if (interval_ == Time{0}) {
      interval_ = std::clamp<Time>(3 * round_trips_.median(), shortest, longest);
      due_ += interval_ - shortest;
    }
    return now >= due_;
  }
  /// They were sent again.
  void resent(Time now) {
    if (sent_at_.size() < most_copies) sent_at_.push_back(now);
    interval_ = std::min<Time>(longest, interval_ + interval_ / 8);
    due_ = now + interval_;
  }

 private:
  static constexpr std::chrono::milliseconds shortest{2};
  static constexpr std::chrono::milliseconds longest{500};
  static constexpr std::size_t most_copies = 1000;
  RoundTrips round_trips_;
  std::uint64_t tick_ = 0;
  std::vector<Time> sent_at_;  // its copies
  Time interval_{0};
  Time due_{0};
};

}  // namespace cohort::lockstep
