// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cohort/client.hpp>

#include "tools/bridges/common/conversation.hpp"

namespace cohort::bridges {

/// The protocol of one robot's firmware, which each bridge implements. RobotBridge attaches to the server, calls this
/// for each frame, and handles silent firmware. Called on one thread.
class Firmware {
 public:
  virtual ~Firmware() = default;

  /// Looks up the robot's channels, at the start and again after each reset. Throws std::runtime_error if this firmware
  /// cannot drive the robot, which ends the bridge.
  virtual void start(const DrivenRobot& robot) = 0;

  /// Makes one exchange: sends the observation and receives the firmware's command, in the order of its protocol, and
  /// keeps the command for `act`. Returns false if the firmware was silent. With Silence::wait, the frame of a robot in
  /// a free team is then not answered, so that the team's `deadline` applies.
  virtual bool exchange(Conversation& conversation, const Observation& observation) = 0;

  /// Sets the robot's command to that of the last exchange.
  virtual void act(Command& command) const = 0;

  /// Drops the last command, so that `act` gives the neutral command. Called if the firmware is silent, with
  /// Silence::stand.
  virtual void stand() = 0;
};

}  // namespace cohort::bridges
