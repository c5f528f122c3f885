#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <vector>

#include "client_sdk/include/cohort/controller.hpp"

namespace cohort::view {

/// The command of a robot that a person drives: the newest values, as long as they are fresh. Any thread.
class HeldCommand {
 public:
  using Clock = std::chrono::steady_clock;
  /// After this silence the page may be gone, and the robot gets its neutral values.
  static constexpr std::chrono::milliseconds longest_silence{500};

  /// Sets the robot's channels. Earlier values stay if they fit them.
  void begin(const std::vector<ChannelInfo>& channels);
  /// All values of all channels in their order, or none for the neutral ones. Throws std::invalid_argument, with a
  /// sentence, if they are of another number or not finite.
  void give(std::vector<double> values, Clock::time_point now);
  /// Empty if the neutral ones are to be used.
  std::vector<double> values(Clock::time_point now) const;
  /// How long nothing has come.
  Clock::duration silence(Clock::time_point now) const;

 private:
  std::vector<double> newest(Clock::time_point now) const;

  mutable std::mutex mutex_;
  std::size_t count_ = 0;
  std::vector<double> values_;
  std::optional<Clock::time_point> given_at_;
};

}  // namespace cohort::view
