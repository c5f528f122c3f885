#pragma once

#include <cohort/controller.hpp>

#include "tools/bridges/autopilots/axes.hpp"

namespace cohort::autopilots {

/// How a vehicle moves, in the frames of autopilots.
struct Motion {
  Vector3 position{};      ///< position of its GPS, from the world's origin, NED [m]
  Vector3 velocity{};      ///< NED [m/s]
  Quaternion attitude{};   ///< FRD to NED
  Vector3 turn_rate{};     ///< FRD [rad/s]
  Vector3 acceleration{};  ///< less gravity, what an accelerometer measures, FRD [m/s^2]
};

/// The sensors `imu` and `gps` of a vehicle.
class MotionSensors {
 public:
  /// Throws ChannelError.
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
