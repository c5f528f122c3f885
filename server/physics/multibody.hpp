#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "server/description/world.hpp"
#include "server/geometry/scene.hpp"
#include "server/physics/bullet.hpp"
#include "server/physics/joint_limit.hpp"
#include "server/physics/joint_motor.hpp"
#include "server/physics/treel_drive.hpp"

namespace cohort::physics {

/// Scratch memory of one worker.
struct Scratch {
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btScalar> scalars;
  btAlignedObjectArray<btMatrix3x3> matrices;
};

/// One instance of a model that moves: Bullet's multibody, with the constraints of its devices.
class Multibody {
 public:
  /// Throws std::invalid_argument for a model that cannot be simulated.
  Multibody(const description::Model& model, const Pose& X_WM, std::uint32_t body, const geometry::Scene& scene);
  Multibody(const Multibody&) = delete;
  Multibody& operator=(const Multibody&) = delete;

  const description::Model& model() const { return *model_; }
  btMultiBody& bullet() { return *multibody_; }
  std::uint32_t body() const { return body_; }

  Pose link_pose(std::size_t link) const;  ///< X_WL
  Twist link_twist(std::size_t link) const;
  double joint_position(std::size_t joint) const;
  double joint_velocity(std::size_t joint) const;

  /// Null if the joint has no motor or the device is no drive.
  JointMotor* motor(std::size_t joint) { return motors_[joint].get(); }
  const JointMotor* motor(std::size_t joint) const { return motors_[joint].get(); }
  TreelDrive* drive(std::size_t device) { return drives_[device].get(); }
  const TreelDrive* drive(std::size_t device) const { return drives_[device].get(); }

  /// All constraints of this body, in a fixed order.
  const std::vector<btMultiBodyConstraint*>& constraints() const { return constraints_; }
  /// Stands for the body in Bullet's solver; no part of the collision.
  btCollisionObject* handle() { return &handle_; }

  /// Applies gravity and damping and takes the forces into the velocities.
  void apply_forces(const Eigen::Vector3d& gravity, double step, Scratch& scratch);
  /// Takes the solver's impulses into the velocities and the velocities into the positions. False if the state is no
  /// longer finite.
  bool integrate(double step, Scratch& scratch);

  void hash(StateHash& hash) const;

 private:
  void build_links(const Pose& X_WM);
  void build_devices(const geometry::Scene& scene);
  Pose bullet_link_pose(std::size_t link) const;  // X_WB

  // Bullet's index of a description link or of a joint's child: the root is -1.
  static int bullet_link(std::size_t link) { return static_cast<int>(link) - 1; }

  const description::Model* model_;
  std::uint32_t body_;
  std::vector<Pose> X_LB_;  // B: Bullet's frame of a link, its centre of mass and principal axes
  std::unique_ptr<btMultiBody> multibody_;
  btMultiBodyLinkCollider handle_;
  std::vector<std::unique_ptr<JointMotor>> motors_;  // by joint
  std::vector<std::unique_ptr<JointLimit>> limits_;
  std::vector<std::unique_ptr<TreelDrive>> drives_;  // by device
  std::vector<btMultiBodyConstraint*> constraints_;
};

}  // namespace cohort::physics
