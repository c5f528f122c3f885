// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "server/description/fluid_devices.hpp"

/// Closed forms of the forces of air and water. Pure functions, callable from any thread.
namespace cohort::physics {

/// Returns the force on a fin [N] along the forward (x) and upward (y) axes of its frame F, in a fluid of this density
/// [kg/m^3]. `v_F`: the fin's velocity relative to the fluid, in F [m/s]. Lift and drag as in Gazebo's LiftDrag, whose
/// coefficients decrease with the cosine of the sweep angle; a flow from behind acts too.
Eigen::Vector2d fin_force(const description::Fin& fin, double density, const Eigen::Vector3d& v_F);

/// Returns the impulse of a force -(linear + quadratic |v|) v over a step, at the velocity v that results from it
/// (implicit Euler). The impulse therefore never reverses the motion. `response`: the change of v by a unit impulse.
double damping_impulse(double v, double linear, double quadratic, double response, double step);

}  // namespace cohort::physics
