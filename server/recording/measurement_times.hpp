// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "server/messages/device_message.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::recording {

/// Determines when one message of a robot's devices has a new measurement, so that a recording has each measurement
/// once.
class MeasurementTimes {
 public:
  MeasurementTimes(const messages::DeviceMessage& message, const Simulation& simulation, std::uint32_t robot);

  /// Starts a world in which the robot is present from tick `since` on. Earlier measurements are ignored.
  void begin(std::uint64_t since) {
    since_ = since;
    last_.reset();
  }
  /// Returns the tick of the newest measurement in the current observation of the robot, which is due now. Returns
  /// nothing before the first report, or if this tick has been returned before.
  std::optional<std::uint64_t> next(const Simulation& simulation);

 private:
  std::uint32_t robot_;
  std::vector<std::size_t> places_;  // index of one observed value of each device
  std::uint64_t since_ = 0;
  std::optional<std::uint64_t> last_;
};

}  // namespace cohort::recording
