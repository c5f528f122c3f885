// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/core/pose.hpp"
#include "server/description/model.hpp"

namespace cohort::physics {

using description::SpatialMatrix;

/// A spatial velocity, acceleration or force; for a force, `angular` is the torque and `linear` the force.
struct Spatial {
  Eigen::Vector3d angular;
  Eigen::Vector3d linear;
};

/// Returns the matrix with cross_matrix(v) * u = v x u.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  return (Eigen::Matrix3d() << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0).finished();
}

/// Returns a spatial inertia about the origin of B as one about `point` in the axes of A (Featherstone, "Rigid body
/// dynamics algorithms", 2008, table 2.8). X_AB: the pose of B; `point` is in A [m].
inline SpatialMatrix moved_inertia(const SpatialMatrix& inertia_B, const Pose& X_AB, const Eigen::Vector3d& point) {
  const Eigen::Matrix3d R_BA = X_AB.orientation.toRotationMatrix().transpose();
  SpatialMatrix to_B = SpatialMatrix::Zero();  // for velocities
  to_B.topLeftCorner<3, 3>() = R_BA;
  to_B.bottomRightCorner<3, 3>() = R_BA;
  to_B.bottomLeftCorner<3, 3>() = -R_BA * cross_matrix(X_AB.position - point);
  return to_B.transpose() * inertia_B * to_B;
}

}  // namespace cohort::physics
