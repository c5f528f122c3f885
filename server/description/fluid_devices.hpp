// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <numbers>
#include <string>

#include "server/core/pose.hpp"
#include "server/description/device_properties.hpp"
#include "server/description/readout.hpp"

/// Devices that interact with air or water, as plain data. Frames: L a link.
namespace cohort::description {

/// A propeller in air or water. The speed of its motor follows the target with a time constant (Furrer et al., "RotorS
/// – A modular Gazebo MAV simulator framework", in: Robot operating system, 2016). At positive velocities the thrust
/// acts along the z axis of R. Command and observation `NAME/0/velocity` [rad/s].
struct Rotor : Thruster {
  std::string name;
  double min_velocity = 0.0;  ///< <= 0 [rad/s]
  double max_velocity = 0.0;  ///< [rad/s]
  Readout readout{};

  static constexpr const char* not_planar = "rotor";
};

/// A surface that generates lift and drag: a wing, rudder, sail or keel. Coefficients as in LiftDrag of Gazebo. In F,
/// at the centre of pressure, x points forward along the chord and z up.
struct Fin {
  std::string name;
  std::size_t link = 0;
  Pose X_LF;
  double area = 0.0;                            ///< [m^2]
  double alpha0 = 0.0;                          ///< added to the angle of attack [rad]
  double cla = 0.0;                             ///< slope of the lift coefficient [1/rad]
  double cda = 0.01;                            ///< slope of the drag coefficient [1/rad]
  double alpha_stall = 0.5 * std::numbers::pi;  ///< where the slopes change [rad]
  double cla_stall = 0.0;                       ///< slope beyond stall [1/rad]
  double cda_stall = 1.0;
};

/// Drag on a link that moves through air or water, for each axis of D. A force acts against the velocity of the origin
/// of D, and a torque against the angular velocity. Each has a part proportional to the velocity v and one proportional
/// to v|v|.
struct Drag {
  std::string name;
  std::size_t link = 0;
  Pose X_LD;
  Eigen::Vector3d damping = Eigen::Vector3d::Zero();                    ///< [N s/m]
  Eigen::Vector3d quadratic_damping = Eigen::Vector3d::Zero();          ///< [N s^2/m^2]
  Eigen::Vector3d angular_damping = Eigen::Vector3d::Zero();            ///< [N m s/rad]
  Eigen::Vector3d quadratic_angular_damping = Eigen::Vector3d::Zero();  ///< [N m s^2/rad^2]
  double density = 0.0;  ///< density of the fluid for which these hold [kg/m^3]; 0 for all fluids
};

}  // namespace cohort::description
