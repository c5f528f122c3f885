#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>

namespace cohort::lockstep {

/// Median of the last 63 tick durations; zero before the first.
class MedianDuration {
 public:
  void add(std::chrono::nanoseconds duration) {
    values_[next_++ % values_.size()] = duration;
    count_ = std::min(count_ + 1, values_.size());
  }
  std::chrono::nanoseconds value() const {
    if (count_ == 0) return std::chrono::nanoseconds{0};
    auto sorted = values_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
    std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(count_));
    return *middle;
  }

 private:
  std::array<std::chrono::nanoseconds, 63> values_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

/// When to send an unanswered frame again: after max(3 ms, 3 median ticks), then at twice the interval each time, at
/// most every 0.5 s. DDS's own repair of a lost sample takes 100 ms and more, since nothing follows it in lockstep.
class ResendTimer {
 public:
  using Time = std::chrono::nanoseconds;

  /// The frame was sent for the first time.
  void start(Time now, Time median_tick) {
    interval_ = std::min<Time>(longest, std::max<Time>(shortest, 3 * median_tick));
    due_ = now + interval_;
  }
  Time due() const { return due_; }
  /// It was sent again.
  void resent(Time now) {
    interval_ = std::min<Time>(longest, 2 * interval_);
    due_ = now + interval_;
  }

 private:
  static constexpr std::chrono::milliseconds shortest{3};
  static constexpr std::chrono::milliseconds longest{500};
  Time interval_{0};
  Time due_{0};
};

}  // namespace cohort::lockstep
