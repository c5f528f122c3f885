// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cohort::lockstep {

/// The last 31 round trips of one client, from the copy of the frame that it received to its answer.
class RoundTrips {
 public:
  using Time = std::chrono::nanoseconds;

  void add(Time duration) {
    values_[next_++ % values_.size()] = duration;
    count_ = std::min(count_ + 1, values_.size());
  }
  /// Returns the median; zero before the first round trip.
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

/// The times to resend a client's unanswered frames: after max(2 ms, 3 times its usual round trip), then at intervals
/// that grow by an eighth each, up to 0.5 s. They grow slowly: at 20 % packet loss, a message of several packets may
/// need ten tries, while a dead client costs only about 50 copies. DDS's own repair of a lost sample takes 100 ms and
/// more, as no later sample follows it in lockstep.
class ResendTimer {
 public:
  using Time = std::chrono::nanoseconds;

  /// Notes the client's last answer, which counts if it answers the last started frame. An answer names the copy of the
  /// frame that it answers, so that lost copies do not make the client seem slow.
  void note_answer(std::uint64_t tick, std::uint32_t copy, Time answered_at) {
    if (tick != tick_ || copy >= sent_at_.size() || answered_at <= sent_at_[copy]) return;
    round_trips_.add(answered_at - sent_at_[copy]);
    sent_at_.clear();
  }
  /// Notes the first sending of the frame of `tick`.
  void start(std::uint64_t tick, Time now) {
    tick_ = tick;
    sent_at_.assign(1, now);
    interval_ = Time{0};  // computed when needed, as most answers arrive before
    due_ = now + shortest;
  }
  /// Returns when `is_due` should be checked next.
  Time due() const { return due_; }
  bool is_due(Time now) {
    if (now < due_) return false;
    if (interval_ == Time{0}) {
      interval_ = std::clamp<Time>(3 * round_trips_.median(), shortest, longest);
      due_ += interval_ - shortest;
    }
    return now >= due_;
  }
  /// Notes that the frames were resent.
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
  std::vector<Time> sent_at_;  // times of its copies
  Time interval_{0};
  Time due_{0};
};

}  // namespace cohort::lockstep
