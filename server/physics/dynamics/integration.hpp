// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/physics/dynamics/body_motion.hpp"

namespace cohort::physics {

/// Moves the body over `step` [s] with the velocities that the solver found.
void integrate(BodyMotion& body, const double* velocities, double step);
/// Moves a body of several segments that touches nothing. Only gravity [m/s^2] and an external impulse [N s], with its
/// moment about the reference point [N m s], change its total momentum.
void fly(BodyMotion& body, const double* velocities, const Eigen::Vector3d& impulse_W,
         const Eigen::Vector3d& angular_impulse_W, const Eigen::Vector3d& gravity, double step);
/// Returns X_WS of a segment as `integrate` would move it over `step` [s] with the present velocities.
Pose pose_ahead(const BodyMotion& body, int segment, double step);

}  // namespace cohort::physics
