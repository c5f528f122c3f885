#pragma once

#include <Eigen/Core>

namespace cohort::physics {

class BodyMotion;

/// All segments of a body with a free root taken together, as they are and move now. In world axes.
struct WholeBody {
  explicit WholeBody(const BodyMotion& body);

  double mass = 0.0;                                    ///< [kg]
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();   ///< of mass
  Eigen::Matrix3d inertia_W = Eigen::Matrix3d::Zero();  ///< about the centre, were the joints locked [kg m^2]
  // What the joints' motion alone has, the root at rest.
  Eigen::Vector3d joints_momentum_W = Eigen::Vector3d::Zero();          ///< [N s]
  Eigen::Vector3d joints_angular_momentum_W = Eigen::Vector3d::Zero();  ///< about the centre [N m s]

  /// Of the root, where the whole has this angular momentum about its centre.
  Eigen::Vector3d angular_velocity_at(const Eigen::Vector3d& angular_momentum_W) const {
    return inertia_W.inverse() * (angular_momentum_W - joints_angular_momentum_W);
  }
};

}  // namespace cohort::physics
