// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

/// Small mechanical systems with a known closed-form solution, which any engine can build. SI units; z points up.
namespace cohort::bench {

/// A rigid body, initially without rotation.
struct RigidBody {
  double mass = 1.0;
  Eigen::Vector3d inertia = Eigen::Vector3d::Ones();  ///< principal moments about its centre, along x, y and z
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> box{};                          ///< edge lengths of its collision box
  Eigen::Vector3d angular_velocity_W = Eigen::Vector3d::Zero();  ///< initial value, for a free body

  /// A point of the hinge axis, which is parallel to y and fixed in the previous body, or in the world for the first
  /// body. A body without it is free.
  std::optional<Eigen::Vector3d> hinge_W{};
};

struct Mechanism {
  double step = 0.01;
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};
  std::optional<double> floor_friction{};  ///< friction of a floor at z = 0 and of all boxes; none: no floor
  std::vector<RigidBody> bodies{};         ///< one free body, or a chain of hinges
};

/// A mechanism in one physics engine.
class MechanismRun {
 public:
  MechanismRun() = default;
  MechanismRun(const MechanismRun&) = delete;
  MechanismRun& operator=(const MechanismRun&) = delete;
  virtual ~MechanismRun() = default;

  virtual void step() = 0;
  // State of a body's centre of mass.
  virtual Eigen::Vector3d position(std::size_t body) const = 0;
  virtual Eigen::Vector3d velocity(std::size_t body) const = 0;
  virtual Eigen::Vector3d angular_velocity(std::size_t body) const = 0;  ///< in the world's axes
  virtual Eigen::Matrix3d rotation(std::size_t body) const = 0;
};

}  // namespace cohort::bench
