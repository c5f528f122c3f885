#pragma once

#include "server/physics/dynamics/body_motion.hpp"

namespace cohort::physics {

/// Takes the velocities that the solver found and moves the body by them over `step` [s].
void integrate(BodyMotion& body, const double* velocities, double step);
/// The same of a body of several segments that touches nothing, which gravity [m/s^2] and an impulse from outside [N s]
/// alone change as a whole, with the moment that it has about the reference [N m s].
void fly(BodyMotion& body, const double* velocities, const Eigen::Vector3d& impulse_W,
         const Eigen::Vector3d& angular_impulse_W, const Eigen::Vector3d& gravity, double step);

}  // namespace cohort::physics
