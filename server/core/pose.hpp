// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace cohort {

/// Pose X_AB of a frame B in a frame A: right-handed, metres, unit quaternion. `X_AB * X_BC` is X_AC, and `X_AB * p_B`
/// is the point p_B expressed in A.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();

  Pose inverse() const {
    const Eigen::Quaterniond inverted = orientation.conjugate();
    return {inverted * (-position), inverted};
  }
  friend Pose operator*(const Pose& a, const Pose& b) {
    return {a.position + a.orientation * b.position, a.orientation * b.orientation};
  }
  friend Eigen::Vector3d operator*(const Pose& a, const Eigen::Vector3d& point) {
    return a.position + a.orientation * point;
  }
};

}  // namespace cohort
