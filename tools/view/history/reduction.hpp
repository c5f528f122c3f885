// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

namespace cohort::view {

/// A value at a time.
struct Sample {
  std::chrono::nanoseconds time{0};
  double value = 0.0;
  bool operator==(const Sample&) const = default;
};

/// Reduces the samples of an interval of time to at most a given number, so that a plot of them looks the same.
///
/// As long as their number is within the limit, all samples are kept. Otherwise the interval is divided into equal
/// parts, and the minimum and maximum of each part are kept, at their times, so that no peak is lost. The first and the
/// last sample are kept too. The memory depends only on the limit.
class Reduction {
 public:
  static constexpr std::size_t least = 4;  ///< smallest limit

  /// The interval is from `from` to `to`, inclusive. `most` is the limit of samples, which must be at least `least`.
  Reduction(std::chrono::nanoseconds from, std::chrono::nanoseconds to, std::size_t most);

  /// Ignores samples outside of the interval. Negative zero becomes zero.
  void add(Sample sample);

  /// Returns true if samples were left out.
  bool is_reduced() const { return !parts_.empty(); }
  /// Returns the samples that remain, in the order of their times.
  std::vector<Sample> samples() const;

 private:
  struct Part {
    Sample least, greatest;
    bool has_any = false;
  };
  void put(const Sample& sample);
  std::size_t part_of(std::chrono::nanoseconds time) const;

  std::chrono::nanoseconds from_, to_;
  std::size_t most_;
  std::vector<Sample> all_;  // until there are too many
  std::vector<Part> parts_;  // from then on, with the first and the last
  Sample first_, last_;
};

}  // namespace cohort::view
