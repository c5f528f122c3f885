#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

/// What every engine builds: the same masses, shapes, sizes and places. SI units and radians; z is up, x of a robot is
/// forward.
namespace cohort::bench {

/// Between what stands in a cell and its border, at the least. [m]
inline constexpr double gap = 0.002;

/// A rigid body with the inertia of a solid cylinder about the vertical axis.
struct CylinderBody {
  double mass = 0.0;    // [kg]
  double radius = 0.0;  // [m]
  double height = 0.0;  // [m]
  double z = 0.0;       // of its centre, above the ground [m]
};

/// The s-bot of worlds/robots/sbot/model.sdf. Its tracks are 5 mm nearer to the middle, so that wheels in their place
/// do not reach beyond the turret.
struct Robot {
  CylinderBody chassis{0.40, 0.05, 0.05, 0.033};  // with wheels and casters
  double hull_radius = 0.05;                      // what collides of the chassis
  double hull_height = 0.04;
  double hull_z = 0.034;
  CylinderBody turret{0.30, 0.058, 0.04, 0.075};  // collides as it is
  double friction = 0.3;                          // of hull and turret, Coulomb

  double half_gauge = 0.035;           // |y| of tracks or wheels
  double half_contact_length = 0.04;   // |x| of the ends of the tracks
  double wheel_radius = 0.022;         // a wheel is a ball
  double wheel_mass = 0.03;            // part of the chassis's
  double track_friction = 0.8;         // of tracks and wheels
  double max_torque = 0.02;            // of each side [N m]
  double max_speed = 0.2;              // of each side [m/s]
  double max_turret_rate = 1.5;        // [rad/s]
  double max_turret_torque = 0.3;      // [N m]
  double caster_radius = 0.01;         // two balls without friction,
  double caster_x = 0.045;             // in front of the wheels and behind them,
  double caster_clearance = 0.0005;    // so far above the ground
  double turret_joint_height = 0.055;  // [m]

  /// The chassis where wheels are bodies of their own; the centre of all stays where it is.
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
  bool planar = false;               ///< Cohort leaves out all that is not in the plane (Fidelity::planar)
  std::optional<double> half_arena;  ///< four walls at this distance from the middle [m]
  bool connected = false;            ///< the turret of each robot is fixed to that of the one before it
  double connection_length = 0.13;   ///< between the middles of two connected turrets, which do not touch [m]
  double step = 0.01;                ///< [s]
  double gravity = 9.81;             ///< [m/s^2]
  double ground_friction = 1.0;
  double wall_thickness = 0.1;
  double wall_height = 0.2;

  /// Of the arena, if it has one.
  std::vector<Wall> walls() const;
};

/// One robot in each cell of a square grid about the origin, at random up to `freedom` from its middle along x and y,
/// and at a random yaw.
std::vector<Placement> in_cells(std::uint32_t robots, double cell, double freedom, std::uint64_t seed);

/// Random places in a square arena of which the robots cover 17 %.
Scene crowd(std::uint32_t robots, std::uint64_t seed);
/// Without walls, and too far apart to meet within five seconds.
Scene spread(std::uint32_t robots, std::uint64_t seed);
/// A straight row of connected robots, one behind the other.
Scene chain(std::uint32_t robots);

}  // namespace cohort::bench
