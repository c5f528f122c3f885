// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdint>

namespace cohort::lockstep {

/// A histogram of durations with buckets 3 % wide, so that a run of any length takes the same memory.
class LatencyHistogram {
 public:
  using Duration = std::chrono::nanoseconds;

  void add(Duration duration) {
    const auto value = static_cast<std::uint64_t>(std::max<Duration::rep>(duration.count(), 0));
    ++counts_[bucket_of(value)];
    ++total_;
    sum_ += duration;
    max_ = std::max(max_, duration);
  }

  /// Returns the quantile of the durations for `share` (0 to 1), accurate to the width of a bucket; zero if there are
  /// none.
  Duration quantile(double share) const {
    if (total_ == 0) return Duration{0};
    const auto rank = static_cast<std::uint64_t>(share * static_cast<double>(total_ - 1));
    std::uint64_t seen = 0;
    for (std::size_t bucket = 0; bucket < counts_.size(); ++bucket) {
      seen += counts_[bucket];
      if (seen > rank) return std::min(max_, Duration{static_cast<Duration::rep>(upper_end(bucket))});
    }
    return max_;
  }
  Duration max() const { return max_; }
  Duration sum() const { return sum_; }
  std::uint64_t count() const { return total_; }

 private:
  // Buckets are exact below 32; above, there are 32 for each power of two.
  static std::size_t bucket_of(std::uint64_t value) {
    if (value < 32) return value;
    const int shift = static_cast<int>(std::bit_width(value)) - 6;
    return 32 * (static_cast<std::size_t>(shift) + 1) + ((value >> shift) - 32);
  }
  static std::uint64_t upper_end(std::size_t bucket) {
    if (bucket < 32) return bucket;
    const std::size_t shift = bucket / 32 - 1;
    return ((bucket % 32 + 33) << shift) - 1;
  }

  std::array<std::uint64_t, std::size_t{32} * 60> counts_{};
  std::uint64_t total_ = 0;
  Duration max_{0};
  Duration sum_{0};
};

}  // namespace cohort::lockstep
