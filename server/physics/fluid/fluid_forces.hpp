#pragma once

#include <Eigen/Core>

#include "server/description/fluid_devices.hpp"

/// Closed forms of what air and water do. Pure functions, callable from any thread.
namespace cohort::physics {

/// On a fin in a fluid of this density, forwards (x) and upwards (y) in its frame F [N]; `v_F`: its velocity relative
/// to the fluid in F [m/s]. Lift and drag of Gazebo's LiftDrag, whose coefficients fall with the cosine of the sweep
/// angle; a flow from behind acts too.
Eigen::Vector2d fin_force(const description::Fin& fin, double density, const Eigen::Vector3d& v_F);

/// The impulse of a force -(linear + quadratic |v|) v over a step, at the velocity v that it leads to itself (implicit
/// Euler), and so never more than stops it. `response`: the change of v by a unit impulse.
double damping_impulse(double v, double linear, double quadratic, double response, double step);

}  // namespace cohort::physics
