// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "server/physics/mechanism/mechanism.hpp"

namespace cohort::physics {

/// A model as planar physics sees it: one mass, and links that joints with motors move as commanded. Immutable; shared
/// by all bodies of the model.
class PlanarModel {
 public:
  /// A joint with a motor.
  struct Motor {
    int segment = 0;
    std::size_t coordinate = 0;
    double lower = 0.0;  ///< [rad] or [m]
    double upper = 0.0;
    double max_velocity = 0.0;  ///< [rad/s] or [m/s]
  };
  static constexpr int no_motor = -1;

  /// Throws std::invalid_argument for a model that cannot be planar.
  explicit PlanarModel(const description::Model& model);

  const Mechanism& mechanism() const { return mechanism_; }
  std::size_t link_count() const { return mechanism_.model().links.size(); }
  /// Returns whether the root is fixed to the world.
  bool is_fixed() const { return !mechanism_.has_free_root(); }
  /// Returns whether no contact can change its motion.
  bool is_immovable() const { return is_fixed() || mechanism_.has_kinematic_root(); }
  const std::vector<Motor>& motors() const { return motors_; }
  int motor_of_joint(std::size_t joint) const { return motor_of_joint_[joint]; }
  int motor_of_segment(int segment) const { return motor_of_segment_[static_cast<std::size_t>(segment)]; }
  /// Returns the track drive, or null if it has none.
  const description::TrackPair* drive() const { return drive_; }

  // Mass properties of the whole model with all joints at zero:
  double mass() const { return mass_; }
  const Eigen::Vector3d& centre() const { return centre_M_; }    ///< centre of mass, in M
  const Eigen::Matrix3d& inertia() const { return inertia_M_; }  ///< about the centre of mass, in M

 private:
  void add_motor(const description::MotorLimits& motor, const std::string& name);
  void add_masses();

  Mechanism mechanism_;
  std::vector<Motor> motors_;
  std::vector<int> motor_of_joint_;
  std::vector<int> motor_of_segment_;
  const description::TrackPair* drive_ = nullptr;
  double mass_ = 0.0;
  Eigen::Vector3d centre_M_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia_M_ = Eigen::Matrix3d::Zero();
};

}  // namespace cohort::physics
