#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "server/core/pose.hpp"
#include "server/description/emitter.hpp"
#include "server/description/input_error.hpp"

/// What the stages need to know of a device, whatever its kind. A kind that has a property derives from it
/// (`TrackPair`, `Thruster`) or answers by a member: `motors`, `belts`, `emitters`, `held_child`, `not_planar`,
/// `readout`. The functions at the end of devices.hpp ask any device. Frames: L a link.
namespace cohort::description {

/// What any motor on a joint has.
struct MotorLimits {
  std::size_t joint = 0;
  double max_velocity = 0.0;  ///< infinite of a motor that does not limit it
  double max_effort = 0.0;
  double rotor_inertia = 0.0;
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
  double wheel_radius = 0.0;         ///< from motor torque to traction [m]
  double max_torque = 0.0;           ///< per side [N m]
  double max_velocity = 0.0;         ///< of the ground points [m/s]
  double friction = 0.0;             ///< Coulomb coefficient of the tracks; a pair has the smaller of the two

  /// The joints of the real wheels that the tracks stand for. Where wheels are simulated (Fidelity::articulated) their
  /// motors are the drive; elsewhere they are welded to the link, and their collisions are none.
  std::vector<std::size_t> left_wheels{};
  std::vector<std::size_t> right_wheels{};
};

/// A propeller, which pushes its link along the z axis of R and turns it about that axis.
struct Thruster {
  /// How it turns at a positive velocity, seen against the z axis of R: from above, if that points up.
  enum class Direction { ccw, cw };

  std::size_t link = 0;  ///< feels thrust, reaction and drag
  Pose X_LR;
  Direction direction = Direction::ccw;
  /// Thrust for each ω|ω| [N s^2/rad^2]. With the thrust coefficient of a propeller of diameter D in a fluid (Fossen,
  /// "Handbook of marine craft hydrodynamics and motion control", 2011, chapter 12), it is density K D^4 / 4π^2.
  double motor_constant = 0.0;
  double moment_constant = 0.0;             ///< reaction torque for each newton of thrust [m]
  double drag_coefficient = 0.0;            ///< force for each |ω| v across the axis [N s^2/(rad m)]
  double rolling_moment_coefficient = 0.0;  ///< torque for the same [N s^2/rad]
  double time_constant_up = 0.0;            ///< while its velocity rises [s]; 0: at once
  double time_constant_down = 0.0;          ///< while it falls [s]
  double density = 0.0;                     ///< of the fluid that the coefficients are of [kg/m^3]; 0: the same in any

  /// Returns the sign of the torque about z at a positive thrust.
  double reaction_sense() const { return direction == Direction::ccw ? -1.0 : 1.0; }
};

/// A sender of messages to the robots around.
struct Beacon {
  double range = 0.0;            ///< [m]
  std::size_t message_size = 0;  ///< values of a message
};

/// An emitter whose output the actuator of its device sets.
struct DeviceEmitter {
  std::size_t link = 0;
  Pose X_LE;
  std::variant<Light, Sound, Marker, Beacon> what;  ///< as it is at first
};

/// Another object of the world, which a device holds.
struct HeldChild {
  std::size_t link = 0;         ///< that holds it
  std::string child;            ///< scoped name of the object
  std::string child_link{};     ///< of it; empty: its root link
  bool may_be_missing = false;  ///< a missing object is not an error
  Problem child_place{};        ///< where a file says so, without a message
};

}  // namespace cohort::description
