#pragma once

#include <cohort/client.hpp>

#include "tools/bridges/common/conversation.hpp"

namespace cohort::bridges {

/// One robot's firmware as its bridge speaks to it: what a bridge has to write. The base attaches to the server, calls
/// this for each frame, and deals with firmware that is silent. One thread.
class Firmware {
 public:
  virtual ~Firmware() = default;

  /// Looks the robot's channels up, at first and again after each reset. Throws std::runtime_error if this firmware
  /// cannot drive the robot, which ends the bridge.
  virtual void start(const DrivenRobot& robot) = 0;

  /// Makes one exchange: sends what the robot senses and receives what the firmware commands, in the order that its
  /// protocol has, and keeps the command for `act`. Returns false if the firmware was silent: under Silence::wait the
  /// frame of a robot whose team is free is then left unanswered, so that its team's `deadline` counts.
  virtual bool exchange(Conversation& conversation, const Observation& observation) = 0;

  /// Sets the robot's command, as the last exchange gave it.
  virtual void act(Command& command) const = 0;

  /// Forgets the last command, so that `act` leaves the robot standing. Called where the firmware is silent and
  /// Silence::stand is asked for.
  virtual void stand() = 0;
};

}  // namespace cohort::bridges
