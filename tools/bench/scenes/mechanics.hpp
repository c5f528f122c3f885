#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

/// Small mechanical systems whose motion is known in closed form, for any engine to build. SI units; z is up.
namespace cohort::bench {

/// A rigid body, at first without rotation.
struct RigidBody {
  double mass = 1.0;
  Eigen::Vector3d inertia = Eigen::Vector3d::Ones();  ///< principal moments about its centre, along x, y and z
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> box{};                          ///< edge lengths of what collides of it
  Eigen::Vector3d angular_velocity_W = Eigen::Vector3d::Zero();  ///< at first, if it is free

  /// It turns about an axis along y through this point, fixed in the body before it, of the first body in the world. A
  /// body without is free.
  std::optional<Eigen::Vector3d> hinge_W{};
};

struct Mechanism {
  double step = 0.01;
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};
  std::optional<double> floor_friction{};  ///< there is a floor at z = 0; of the floor and of all boxes
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
  // Of the centre of a body.
  virtual Eigen::Vector3d position(std::size_t body) const = 0;
  virtual Eigen::Vector3d velocity(std::size_t body) const = 0;
  virtual Eigen::Vector3d angular_velocity(std::size_t body) const = 0;  ///< in the world's axes
  virtual Eigen::Matrix3d rotation(std::size_t body) const = 0;
};

}  // namespace cohort::bench
