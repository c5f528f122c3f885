// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

/// Scenes that every engine builds, with the same masses, shapes, sizes and poses. SI units and radians; z points up,
/// and x of a robot forward.
namespace cohort::bench {

/// Minimum distance between an object in a cell and the border of the cell. [m]
inline constexpr double gap = 0.002;

/// A rigid body with the inertia of a solid cylinder about the vertical axis.
struct CylinderBody {
  double mass = 0.0;    // [kg]
  double radius = 0.0;  // [m]
  double height = 0.0;  // [m]
  double z = 0.0;       // height of its centre above the ground [m]
};

/// The s-bot of worlds/robots/sbot/model.sdf. Its tracks are 5 mm closer to the centre, so that wheels in their place
/// do not extend beyond the turret.
struct Robot {
  CylinderBody chassis{0.40, 0.05, 0.05, 0.033};  // with wheels and casters
  double hull_radius = 0.05;                      // radius of the chassis's collision shape
  double hull_height = 0.04;
  double hull_z = 0.034;
  CylinderBody turret{0.30, 0.058, 0.04, 0.075};  // also its collision shape
  double friction = 0.3;                          // Coulomb friction of hull and turret

  double half_gauge = 0.035;           // |y| of tracks or wheels
  double half_contact_length = 0.04;   // |x| of the ends of the tracks
  double wheel_radius = 0.022;         // a wheel is a ball
  double wheel_mass = 0.03;            // part of the chassis's mass
  double track_friction = 0.8;         // friction of tracks and wheels
  double max_torque = 0.02;            // maximum torque of each side [N m]
  double max_speed = 0.2;              // maximum speed of each side [m/s]
  double max_turret_rate = 1.5;        // [rad/s]
  double max_turret_torque = 0.3;      // [N m]
  double caster_radius = 0.01;         // two balls without friction,
  double caster_x = 0.045;             // in front of the wheels and behind them,
  double caster_clearance = 0.0005;    // and their clearance above the ground
  double turret_joint_height = 0.055;  // [m]

  /// Returns the chassis without the mass of wheels that are separate bodies; the common centre of mass is unchanged.
  CylinderBody chassis_without_wheels() const;
};

enum class Drive {
  tracks,  ///< Cohort's treel drive; engines without one have wheels
  wheels,  ///< two wheels on joints and two casters in every engine
};

struct Placement {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;
};

struct Wall {
  Eigen::Vector3d centre;
  Eigen::Vector3d size;
};

struct Scene {
  Robot robot;
  Drive drive = Drive::tracks;
  std::vector<Placement> robots;
  bool planar = false;               ///< Cohort simulates motion in the plane only (Fidelity::planar)
  std::optional<double> half_arena;  ///< distance of four walls from the centre [m]
  bool connected = false;            ///< the turret of each robot is fixed to that of the previous robot
  double connection_length = 0.13;   ///< distance of the centres of two connected turrets, which do not touch [m]
  double step = 0.01;                ///< [s]
  double gravity = 9.81;             ///< [m/s^2]
  double ground_friction = 1.0;
  double wall_thickness = 0.1;
  double wall_height = 0.2;

  /// Returns the walls of the arena, if it has one.
  std::vector<Wall> walls() const;
};

/// Returns one robot in each cell of a square grid about the origin. Each has a random displacement of up to `freedom`
/// from the centre of its cell along x and y, and a random yaw.
std::vector<Placement> in_cells(std::uint32_t robots, double cell, double freedom, std::uint64_t seed);

/// Returns robots at random positions in a square arena, of which they cover 17 %.
Scene crowd(std::uint32_t robots, std::uint64_t seed);
/// Returns robots without walls, too far apart to meet within the first 4.7 seconds.
Scene spread(std::uint32_t robots, std::uint64_t seed);
/// Returns a straight row of connected robots, one behind the other.
Scene chain(std::uint32_t robots);

}  // namespace cohort::bench
