// SPDX-License-Identifier: Apache-2.0
#include "server/physics/fluid/fluid_forces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cohort::physics {

Eigen::Vector2d fin_force(const description::Fin& fin, double density, const Eigen::Vector3d& v_F) {
  const double u = v_F.x();
  const double w = v_F.z();
  const double speed = std::sqrt(u * u + w * w);
  if (speed == 0.0) return Eigen::Vector2d::Zero();
  const double alpha = std::remainder(fin.alpha0 + std::atan2(-w, u), std::numbers::pi);
  const double attached = std::clamp(alpha, -fin.alpha_stall, fin.alpha_stall);
  const double stalled = alpha - attached;
  double lift = fin.cla * attached + fin.cla_stall * stalled;
  if (stalled > 0.0) lift = std::max(0.0, lift);
  if (stalled < 0.0) lift = std::min(0.0, lift);
  const double drag = std::abs(fin.cda * attached + fin.cda_stall * stalled);
  const double cos_sweep = speed / v_F.norm();
  const double pressure_over_speed = 0.5 * density * speed * fin.area * cos_sweep;
  return pressure_over_speed * (lift * Eigen::Vector2d(-w, u) - drag * Eigen::Vector2d(u, w));
}

double damping_impulse(double v, double linear, double quadratic, double response, double step) {
  // Solve |v'| (1 + a) + b |v'|^2 = |v|.
  const double a = step * response * linear;
  const double b = step * response * quadratic;
  const double speed = std::abs(v);
  const double after = 2.0 * speed / (1.0 + a + std::sqrt((1.0 + a) * (1.0 + a) + 4.0 * b * speed));
  return std::copysign(step * (linear + quadratic * after) * after, -v);
}

}  // namespace cohort::physics
