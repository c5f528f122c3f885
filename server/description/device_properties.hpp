#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "server/core/pose.hpp"
#include "server/description/emitter.hpp"
#include "server/description/input_error.hpp"

/// What the stages need to know of a device, whatever its kind. A kind that has a property answers by a member:
/// `motors`, `belts`, `tracks`, `thruster`, `emitters`, `held_child`, `not_planar`, `readout`. The functions at the end
/// of devices.hpp ask any device. Frames: L a link.
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
  double friction = 0.0;             ///< Coulomb coefficient of the tracks

  /// The joints of the wheels that the tracks stand for, which drive where wheels are simulated.
  std::vector<std::size_t> left_wheels{};
  std::vector<std::size_t> right_wheels{};
};

/// A propeller, which pushes its link along the z axis of R and turns it about that axis.
struct Thruster {
  std::size_t link = 0;
  Pose X_LR;
  double reaction_sense = -1.0;             ///< of the torque about z at a positive thrust: 1 or -1
  double motor_constant = 0.0;              ///< thrust for each ω|ω| [N s^2/rad^2]
  double moment_constant = 0.0;             ///< reaction torque for each newton of thrust [m]
  double drag_coefficient = 0.0;            ///< force for each |ω| v across the axis [N s^2/(rad m)]
  double rolling_moment_coefficient = 0.0;  ///< torque for the same [N s^2/rad]
  double time_constant_up = 0.0;            ///< while its velocity rises [s]; 0: at once
  double time_constant_down = 0.0;          ///< while it falls [s]
  double density = 0.0;                     ///< of the fluid that the coefficients are of [kg/m^3]; 0: the same in any
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
