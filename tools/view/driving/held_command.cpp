// SPDX-License-Identifier: Apache-2.0
#include "tools/view/driving/held_command.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace cohort::view {

void HeldCommand::begin(const std::vector<ChannelInfo>& channels) {
  const std::lock_guard lock(mutex_);
  count_ = 0;
  for (const ChannelInfo& channel : channels) count_ += channel.size;
  if (values_.size() != count_) values_.clear();
}

void HeldCommand::give(std::vector<double> values, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (!values.empty() && values.size() != count_)
    throw std::invalid_argument("the robot's command has " + std::to_string(count_) + " values, not " +
                                std::to_string(values.size()));
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
    throw std::invalid_argument("expected finite numbers in a command");
  values_ = std::move(values);
  given_at_ = now;
}

std::vector<double> HeldCommand::values(Clock::time_point now) const {
  const std::lock_guard lock(mutex_);
  const bool is_fresh = given_at_ && now - *given_at_ <= longest_silence;
  return is_fresh ? values_ : std::vector<double>();
}

HeldCommand::Clock::duration HeldCommand::silence(Clock::time_point now) const {
  const std::lock_guard lock(mutex_);
  return given_at_ ? now - *given_at_ : Clock::duration::zero();
}

}  // namespace cohort::view
