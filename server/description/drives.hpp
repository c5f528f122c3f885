#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "server/core/pose.hpp"
#include "server/description/device_properties.hpp"

/// The devices that drive joints, tracks and belts. Frames: L a link.
namespace cohort::description {

/// Two tracks that share one rigid body ("treels", tracks and wheels of the s-bot): drawn as four ground points, two a
/// side. Commands `NAME/left/velocity` and `NAME/right/velocity` [m/s].
struct TreelDrive : TrackPair {
  std::string name;
};

/// A motor with a velocity loop on one joint, on the first axis of a universal one. Command `NAME/0/velocity` [rad/s]
/// or [m/s].
struct VelocityMotor {
  std::string name;
  std::size_t joint = 0;
  double max_velocity = 0.0;
  double max_effort = 0.0;     ///< [N m] or [N]
  double rotor_inertia = 0.0;  ///< of what turns in the motor, as the joint feels it [kg m^2] or [kg]

  std::vector<MotorLimits> motors() const;
};

/// A motor that takes a joint to a position and holds it there. Command `NAME/0/position` [rad] or [m].
struct PositionMotor {
  std::string name;
  std::size_t joint = 0;
  double max_velocity = 0.0;
  double max_effort = 0.0;
  double rotor_inertia = 0.0;

  std::vector<MotorLimits> motors() const;
};

/// A motor that gives a torque or a force. Command `NAME/0/effort` [N m] or [N].
struct EffortMotor {
  std::string name;
  std::size_t joint = 0;
  double max_effort = 0.0;
  double rotor_inertia = 0.0;

  std::vector<MotorLimits> motors() const;
};

/// A motor on each wheel of a vehicle that turns by their difference. Commands `NAME/0/linear` [m/s], forward, and
/// `NAME/0/angular` [rad/s], counter-clockwise. A positive velocity of the joint of a wheel drives forward.
struct DifferentialDrive {
  std::string name;
  std::vector<std::size_t> left_joints{};
  std::vector<std::size_t> right_joints{};
  double wheel_separation = 0.0;  ///< between the left wheels and the right ones [m]
  double wheel_radius = 0.0;      ///< [m]
  double max_torque = 0.0;        ///< of the motor of each wheel [N m]
  double max_linear = 0.0;        ///< [m/s]
  double max_angular = 0.0;       ///< [rad/s]

  std::vector<MotorLimits> motors() const;
};

/// A vehicle that steers two wheels as a car: all of them roll about one centre. Commands as of a DifferentialDrive;
/// the limit of its steering is the tightest turn.
struct AckermannDrive {
  std::string name;
  std::vector<std::size_t> left_joints{};  ///< of the wheels that are driven
  std::vector<std::size_t> right_joints{};
  std::size_t left_steering_joint = 0;  ///< turns a wheel counter-clockwise at a positive position
  std::size_t right_steering_joint = 0;
  double wheel_separation = 0.0;       ///< between the left wheels and the right ones [m]
  double wheel_radius = 0.0;           ///< [m]
  double max_torque = 0.0;             ///< of the motor of each wheel [N m]
  double wheel_base = 0.0;             ///< from the rear axle, which does not steer, to the steered wheels [m]
  double kingpin_width = 0.0;          ///< between the axes of the steering joints [m]
  double steering_limit = 0.0;         ///< of a wheel in the middle of the two [rad]
  double max_linear = 0.0;             ///< [m/s]
  double max_angular = 0.0;            ///< [rad/s]
  double max_steering_velocity = 0.0;  ///< of each steering joint [rad/s]
  double max_steering_torque = 0.0;    ///< [N m]

  std::vector<MotorLimits> motors() const;
};

/// A link whose surface runs round it, as that of a conveyor or of the track of a vehicle. At a positive velocity it
/// runs as that of a wheel that turns about the axis: with the axis to the left what lies on top is carried forward,
/// and what stands on the ground drives forward. Friction of the link's collisions alone limits what it carries.
/// Command `NAME/0/velocity` [m/s].
struct Belt {
  std::string name;
  std::size_t link = 0;
  Eigen::Vector3d axis_L = Eigen::Vector3d::UnitY();  ///< of any length but 0
  double max_velocity = 0.0;                          ///< [m/s]
  double velocity = 0.0;                              ///< where nobody commands it [m/s]

  static constexpr const char* not_planar = "the belts of";
  std::vector<BeltPlace> belts() const;
};

/// Belts on both sides of a vehicle that turns by their difference, about the y axes of their links. Commands as of a
/// DifferentialDrive.
struct TrackedDrive {
  std::string name;
  std::vector<std::size_t> left_links{};
  std::vector<std::size_t> right_links{};
  double track_separation = 0.0;     ///< between the middles of the left tracks and of the right ones [m]
  double steering_efficiency = 1.0;  ///< share of the difference of the tracks that turns it; the rest slips [1]
  double max_velocity = std::numeric_limits<double>::infinity();  ///< of each track [m/s]
  double max_linear = 0.0;                                        ///< [m/s]
  double max_angular = 0.0;                                       ///< [rad/s]

  static constexpr const char* not_planar = "the belts of";
  std::vector<BeltPlace> belts() const;
};

}  // namespace cohort::description
