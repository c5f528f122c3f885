// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "server/core/pose.hpp"
#include "server/description/emitter.hpp"
#include "server/description/input_error.hpp"

/// Properties of devices that the stages of the simulation need, for any kind of device. A kind that has a property
/// derives from it (`TrackPair`, `Thruster`) or has a member for it: `motors`, `belts`, `emitters`, `held_child`,
/// `not_planar`, `readout`. The functions at the end of devices.hpp read them from any device. Frames: L a link, R a
/// rotor, E an emitter.
namespace cohort::description {

/// Limits of a motor on a joint.
struct MotorLimits {
  std::size_t joint = 0;
  double max_velocity = 0.0;   ///< [rad/s] or [m/s]; infinite for a motor without a limit
  double max_effort = 0.0;     ///< [N m] or [N]
  double rotor_inertia = 0.0;  ///< rotor inertia reflected to the joint [kg m^2] or [kg]
};

/// A link whose surface a device drives.
struct BeltPlace {
  std::size_t link = 0;
  Eigen::Vector3d axis_L;  ///< unit
};

/// Two tracks that share one rigid body and stand on the ground at four points, two a side.
struct TrackPair {
  std::size_t link = 0;
  double half_gauge = 0.0;           ///< |y| of the ground points in the link's frame [m]
  double half_contact_length = 0.0;  ///< |x| of the ground points [m]
  double ground_height = 0.0;        ///< z of the ground points [m]
  double wheel_radius = 0.0;         ///< converts motor torque to traction [m]
  double max_torque = 0.0;           ///< per side [N m]
  double max_velocity = 0.0;         ///< velocity of the ground points [m/s]
  double friction = 0.0;             ///< Coulomb coefficient of the tracks; a contact uses the smaller of the two

  /// Joints of the real wheels that the tracks replace. Where wheels are simulated (Fidelity::articulated), their
  /// motors are the drive; elsewhere the wheels are welded to the link and have no collisions.
  std::vector<std::size_t> left_wheels{};
  std::vector<std::size_t> right_wheels{};
};

/// A propeller, which pushes its link along the z axis of R and turns it about that axis.
struct Thruster {
  /// Direction of rotation at a positive velocity, seen from the positive z axis of R (from above, if that axis points
  /// up).
  enum class Direction { ccw, cw };

  std::size_t link = 0;  ///< on which thrust, reaction torque and drag act
  Pose X_LR;
  Direction direction = Direction::ccw;
  /// Ratio of thrust to ω|ω| [N s^2/rad^2]. A propeller of diameter D with thrust coefficient K has
  /// density K D^4 / 4π^2 (Fossen, "Handbook of marine craft hydrodynamics and motion control", 2011, chapter 12).
  double motor_constant = 0.0;
  double moment_constant = 0.0;             ///< ratio of reaction torque to thrust [m]
  double drag_coefficient = 0.0;            ///< force per |ω| v perpendicular to the axis [N s^2/(rad m)]
  double rolling_moment_coefficient = 0.0;  ///< torque per |ω| v perpendicular to the axis [N s^2/rad]
  double time_constant_up = 0.0;            ///< while the velocity increases [s]; 0 for no delay
  double time_constant_down = 0.0;          ///< while the velocity decreases [s]
  double density = 0.0;  ///< density of the fluid for which the coefficients hold [kg/m^3]; 0 for all fluids

  /// Returns the sign of the torque about z at a positive thrust.
  double reaction_sense() const { return direction == Direction::ccw ? -1.0 : 1.0; }
};

/// A sender of messages to nearby robots.
struct Beacon {
  double range = 0.0;            ///< [m]
  std::size_t message_size = 0;  ///< number of values in a message
};

/// An emitter whose output is set by the actuator of its device.
struct DeviceEmitter {
  std::size_t link = 0;
  Pose X_LE;
  std::variant<Light, Sound, Marker, Beacon> what;  ///< initial state
};

/// Another object of the world that is attached to a device.
struct HeldChild {
  std::size_t link = 0;         ///< to which the object is attached
  std::string child;            ///< scoped name of the object
  std::string child_link{};     ///< link of the object; empty for its root link
  bool may_be_missing = false;  ///< a missing object is not an error
  Problem child_place{};        ///< position in the file, without a message
};

}  // namespace cohort::description
