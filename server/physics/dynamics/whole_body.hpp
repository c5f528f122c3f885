// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace cohort::physics {

class BodyMotion;

/// Mass, momentum and inertia of all segments of a body with a free root, at its present state. In world axes.
struct WholeBody {
  explicit WholeBody(const BodyMotion& body);

  double mass = 0.0;                                    ///< [kg]
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();   ///< centre of mass
  Eigen::Matrix3d inertia_W = Eigen::Matrix3d::Zero();  ///< about the centre, with locked joints [kg m^2]
  // Momentum of the joints' motion alone, with the root at rest.
  Eigen::Vector3d joints_momentum_W = Eigen::Vector3d::Zero();          ///< [N s]
  Eigen::Vector3d joints_angular_momentum_W = Eigen::Vector3d::Zero();  ///< about the centre [N m s]

  /// Returns the root's angular velocity at which the whole body has this angular momentum about its centre of mass.
  Eigen::Vector3d angular_velocity_at(const Eigen::Vector3d& angular_momentum_W) const {
    return inertia_W.inverse() * (angular_momentum_W - joints_angular_momentum_W);
  }
};

}  // namespace cohort::physics
