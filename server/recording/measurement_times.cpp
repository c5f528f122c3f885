// SPDX-License-Identifier: Apache-2.0
#include "server/recording/measurement_times.hpp"

#include <algorithm>
#include <set>
#include <string>

namespace cohort::recording {

MeasurementTimes::MeasurementTimes(const messages::DeviceMessage& message, const Simulation& simulation,
                                   std::uint32_t robot)
    : robot_(robot) {
  std::set<std::string> devices(message.devices.begin(), message.devices.end());
  std::size_t place = 0;
  for (const cohort::Channel& channel : simulation.kinds()[simulation.kind_of(robot)].observation) {
    if (devices.erase(channel.name.substr(0, channel.name.find('/'))) > 0) places_.push_back(place);
    place += channel.size;
  }
}

std::optional<std::uint64_t> MeasurementTimes::next(const Simulation& simulation) {
  std::optional<std::uint64_t> newest;
  for (const std::size_t place : places_) newest = std::max(newest, simulation.measurement_at(robot_, place));
  if (!newest || *newest < since_ || newest == last_) return std::nullopt;
  last_ = newest;
  return newest;
}

}  // namespace cohort::recording
