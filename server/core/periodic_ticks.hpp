// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace cohort {

/// Returns the number of steps in `time` if it is a whole number, otherwise nothing. Times and steps are rounded to
/// nanoseconds, each by up to half a nanosecond, so n steps can differ from the same time by (n + 1) / 2 nanoseconds.
inline std::optional<std::uint64_t> whole_steps(std::chrono::nanoseconds time, std::chrono::nanoseconds step) {
  const std::int64_t steps = (time + step / 2) / step;
  const std::int64_t difference = std::abs((time - steps * step).count());
  return 2 * difference <= steps + 1 ? std::optional(static_cast<std::uint64_t>(steps)) : std::nullopt;
}

/// The ticks of a periodic event, from tick 0 on. If the period is not a whole number of steps, each occurrence is at
/// the nearest tick, so that the average rate is exact.
class PeriodicTicks {
 public:
  /// Every tick.
  PeriodicTicks() = default;
  /// The event occurs at every tick if the period is shorter than a step.
  PeriodicTicks(std::chrono::nanoseconds period, std::chrono::nanoseconds step)
      : step_(step), period_(std::max(period, step)), ticks_(whole_steps(period_, step).value_or(0)) {}
  /// `rate`: occurrences per second [Hz], more than 0.
  static PeriodicTicks at_rate(double rate, std::chrono::nanoseconds step) {
    constexpr double longest = 9e18;  // [ns], about the largest number of nanoseconds
    return {std::chrono::nanoseconds(static_cast<std::int64_t>(std::min(1e9 / rate + 0.5, longest))), step};
  }

  /// Returns the number of occurrences after tick 0, up to and including this tick.
  std::uint64_t count(std::uint64_t tick) const {
    if (ticks_ != 0) return tick / ticks_;
    return static_cast<std::uint64_t>((static_cast<std::int64_t>(tick) * step_ + step_ / 2) / period_);
  }
  /// Returns the tick of occurrence number `count` after tick 0: the first tick with this count.
  std::uint64_t tick_of(std::uint64_t count) const {
    if (ticks_ != 0 || count == 0) return count * ticks_;
    const std::chrono::nanoseconds least = static_cast<std::int64_t>(count) * period_ - step_ / 2;
    return static_cast<std::uint64_t>((least + step_ - std::chrono::nanoseconds(1)) / step_);
  }
  bool contains(std::uint64_t tick) const {
    if (ticks_ != 0) return tick % ticks_ == 0;
    return tick == 0 || count(tick) != count(tick - 1);
  }
  bool is_every_tick() const { return ticks_ == 1; }
  /// Returns the mean time between occurrences.
  std::chrono::nanoseconds period() const { return ticks_ != 0 ? static_cast<std::int64_t>(ticks_) * step_ : period_; }

 private:
  std::chrono::nanoseconds step_{1};
  std::chrono::nanoseconds period_{1};
  std::uint64_t ticks_ = 1;  // period in ticks; 0: not whole
};

}  // namespace cohort
