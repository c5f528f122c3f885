// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cohort/controller.hpp>

#include "tools/bridges/autopilots/axes.hpp"

namespace cohort::autopilots {

/// The motion of a vehicle, in the frames of autopilots.
struct Motion {
  Vector3 position{};      ///< position of the GPS receiver relative to the world's origin, NED [m]
  Vector3 velocity{};      ///< NED [m/s]
  Quaternion attitude{};   ///< FRD to NED
  Vector3 turn_rate{};     ///< FRD [rad/s]
  Vector3 acceleration{};  ///< specific force, as an accelerometer measures it, FRD [m/s^2]
};

/// The sensors `imu` and `gps` of a vehicle.
class MotionSensors {
 public:
  /// Looks up the channels. Throws ChannelError if one is missing.
  void start(const Start& start) {
    orientation_ = start.observation("imu/0/orientation");
    turn_rate_ = start.observation("imu/0/angular_velocity");
    acceleration_ = start.observation("imu/0/linear_acceleration");
    position_ = start.observation("gps/0/position");
    velocity_ = start.observation("gps/0/velocity");
  }

  Motion sense(const Observation& observation) const {
    return {to_ned(observation.values(position_)), to_ned(observation.values(velocity_)),
            frd_to_ned(observation.values(orientation_)), to_frd(observation.values(turn_rate_)),
            to_frd(observation.values(acceleration_))};
  }

 private:
  ObservationChannel orientation_;
  ObservationChannel turn_rate_;
  ObservationChannel acceleration_;
  ObservationChannel position_;
  ObservationChannel velocity_;
};

}  // namespace cohort::autopilots
