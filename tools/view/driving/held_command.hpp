// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <vector>

#include "client_sdk/include/cohort/controller.hpp"

namespace cohort::view {

/// The command of a robot that a user drives: the latest values, as long as they are recent. Thread-safe.
class HeldCommand {
 public:
  using Clock = std::chrono::steady_clock;
  /// After this time without values, the page may be gone, and the robot gets its neutral command.
  static constexpr std::chrono::milliseconds longest_silence{500};

  /// Sets the robot's channels. Keeps earlier values if their number matches.
  void begin(const std::vector<ChannelInfo>& channels);
  /// Sets the values of all channels, in order; empty for the neutral command. Throws std::invalid_argument, with a
  /// message to the user, if their number is wrong or one is not finite.
  void give(std::vector<double> values, Clock::time_point now);
  /// Returns the values; empty for the neutral command.
  std::vector<double> values(Clock::time_point now) const;
  /// Returns the time since the latest values were set; zero if there were none.
  Clock::duration silence(Clock::time_point now) const;

 private:
  std::vector<double> newest(Clock::time_point now) const;

  mutable std::mutex mutex_;
  std::size_t count_ = 0;
  std::vector<double> values_;
  std::optional<Clock::time_point> given_at_;
};

}  // namespace cohort::view
