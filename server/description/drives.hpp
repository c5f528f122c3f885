// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "server/core/pose.hpp"
#include "server/description/device_properties.hpp"

/// Devices that drive joints, tracks and belts. Frames: L a link.
namespace cohort::description {

/// Two tracks that share one rigid body ("treels", tracks and wheels of the s-bot), modelled as four ground points, two
/// on each side. Commands `NAME/left/velocity` and `NAME/right/velocity` [m/s].
struct TreelDrive : TrackPair {
  std::string name;
};

/// A motor that controls the velocity of one joint (of a universal joint, its first axis). Command `NAME/0/velocity`
/// [rad/s] or [m/s].
struct VelocityMotor {
  std::string name;
  std::size_t joint = 0;
  double max_velocity = 0.0;
  double max_effort = 0.0;     ///< [N m] or [N]
  double rotor_inertia = 0.0;  ///< rotor inertia reflected to the joint [kg m^2] or [kg]

  std::vector<MotorLimits> motors() const;
};

/// A motor that moves a joint to a position and holds it there. Command `NAME/0/position` [rad] or [m].
struct PositionMotor {
  std::string name;
  std::size_t joint = 0;
  double max_velocity = 0.0;
  double max_effort = 0.0;
  double rotor_inertia = 0.0;

  std::vector<MotorLimits> motors() const;
};

/// A motor that applies a torque or a force. Command `NAME/0/effort` [N m] or [N].
struct EffortMotor {
  std::string name;
  std::size_t joint = 0;
  double max_effort = 0.0;
  double rotor_inertia = 0.0;

  std::vector<MotorLimits> motors() const;
};

/// A drive with a motor on each wheel; the difference between the sides turns the vehicle. Commands `NAME/0/linear`
/// [m/s], forward, and `NAME/0/angular` [rad/s], counter-clockwise. A positive velocity of the joint of a wheel drives
/// forward.
struct DifferentialDrive {
  std::string name;
  std::vector<std::size_t> left_joints{};
  std::vector<std::size_t> right_joints{};
  double wheel_separation = 0.0;  ///< distance between the left and the right wheels [m]
  double wheel_radius = 0.0;      ///< [m]
  double max_torque = 0.0;        ///< for the motor of each wheel [N m]
  double max_linear = 0.0;        ///< [m/s]
  double max_angular = 0.0;       ///< [rad/s]

  std::vector<MotorLimits> motors() const;
};

/// A drive that steers two wheels, like a car: all wheels roll about one centre. Commands as for a DifferentialDrive;
/// the steering limit defines the tightest turn.
struct AckermannDrive {
  std::string name;
  std::vector<std::size_t> left_joints{};  ///< joints of the driven wheels
  std::vector<std::size_t> right_joints{};
  std::size_t left_steering_joint = 0;  ///< turns a wheel counter-clockwise at a positive position
  std::size_t right_steering_joint = 0;
  double wheel_separation = 0.0;       ///< distance between the left and the right wheels [m]
  double wheel_radius = 0.0;           ///< [m]
  double max_torque = 0.0;             ///< for the motor of each wheel [N m]
  double wheel_base = 0.0;             ///< distance from the rear axle, which does not steer, to the steered wheels [m]
  double kingpin_width = 0.0;          ///< distance between the axes of the steering joints [m]
  double steering_limit = 0.0;         ///< for a virtual wheel midway between the two [rad]
  double max_linear = 0.0;             ///< [m/s]
  double max_angular = 0.0;            ///< [rad/s]
  double max_steering_velocity = 0.0;  ///< for each steering joint [rad/s]
  double max_steering_torque = 0.0;    ///< [N m]

  std::vector<MotorLimits> motors() const;
};

/// A link with a moving surface, such as that of a conveyor or a track. At a positive velocity the surface moves like
/// that of a wheel that turns about the axis. If the axis points to the left, objects on top are carried forward, and a
/// vehicle on the ground drives forward. Only the friction of the collisions of the link limits what it carries.
/// Command `NAME/0/velocity` [m/s].
struct Belt {
  std::string name;
  std::size_t link = 0;
  Eigen::Vector3d axis_L = Eigen::Vector3d::UnitY();  ///< any length but 0
  double max_velocity = 0.0;                          ///< [m/s]
  double velocity = 0.0;                              ///< without a command [m/s]

  static constexpr const char* not_planar = "the belts of";
  std::vector<BeltPlace> belts() const;
};

/// A drive with belts on both sides, which run about the y axes of their links; the difference between the sides turns
/// the vehicle. Commands as for a DifferentialDrive.
struct TrackedDrive {
  std::string name;
  std::vector<std::size_t> left_links{};
  std::vector<std::size_t> right_links{};
  double track_separation = 0.0;     ///< distance between the centre lines of the left and the right tracks [m]
  double steering_efficiency = 1.0;  ///< fraction of the track velocity difference that turns the vehicle [1]
  double max_velocity = std::numeric_limits<double>::infinity();  ///< for each track [m/s]
  double max_linear = 0.0;                                        ///< [m/s]
  double max_angular = 0.0;                                       ///< [rad/s]

  static constexpr const char* not_planar = "the belts of";
  std::vector<BeltPlace> belts() const;
};

}  // namespace cohort::description
