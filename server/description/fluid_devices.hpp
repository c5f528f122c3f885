#pragma once

#include <cstddef>
#include <numbers>
#include <string>

#include "server/core/pose.hpp"
#include "server/description/device_properties.hpp"
#include "server/description/readout.hpp"

/// What pushes air or water, or is pushed by them, as plain data. Frames: L a link.
namespace cohort::description {

/// A propeller in air or water, of a motor whose speed follows its target with a time constant (Furrer et al., "RotorS
/// – A modular Gazebo MAV simulator framework", in: Robot operating system, 2016). Its thrust is along the z axis of R
/// at positive velocities. Command and observation `NAME/0/velocity` [rad/s].
struct Rotor : Thruster {
  std::string name;
  double min_velocity = 0.0;  ///< <= 0 [rad/s]
  double max_velocity = 0.0;  ///< [rad/s]
  Readout readout{};

  static constexpr const char* not_planar = "rotor";
};

/// A surface that gives lift and drag: a wing, a rudder, a sail, a keel. Coefficients as of Gazebo's LiftDrag. In F, at
/// the centre of pressure, x is forward along the chord and z up.
struct Fin {
  std::string name;
  std::size_t link = 0;
  Pose X_LF;
  double area = 0.0;                            ///< [m^2]
  double alpha0 = 0.0;                          ///< added to the angle of attack [rad]
  double cla = 0.0;                             ///< slope of the coefficient of lift [1/rad]
  double cda = 0.01;                            ///< the same of drag [1/rad]
  double alpha_stall = 0.5 * std::numbers::pi;  ///< where the slopes change [rad]
  double cla_stall = 0.0;                       ///< slopes beyond [1/rad]
  double cda_stall = 1.0;
};

/// What resists the motion of a link through air or water, axis by axis in D: of the origin of D by a force, and of
/// turning by a torque, each with a part in proportion to the velocity v and one to v|v|.
struct Drag {
  std::string name;
  std::size_t link = 0;
  Pose X_LD;
  Eigen::Vector3d damping = Eigen::Vector3d::Zero();                    ///< [N s/m]
  Eigen::Vector3d quadratic_damping = Eigen::Vector3d::Zero();          ///< [N s^2/m^2]
  Eigen::Vector3d angular_damping = Eigen::Vector3d::Zero();            ///< [N m s/rad]
  Eigen::Vector3d quadratic_angular_damping = Eigen::Vector3d::Zero();  ///< [N m s^2/rad^2]
  double density = 0.0;  ///< of the fluid that these are of [kg/m^3]; 0: the same in any
};

}  // namespace cohort::description
