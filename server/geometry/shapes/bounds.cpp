// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/shapes/bounds.hpp"

#include <algorithm>
#include <cmath>

#include "server/core/infinity.hpp"

namespace cohort::geometry {

using Eigen::Vector3d;

double Bounds::last_along(const Vector3d& origin, const Vector3d& direction) const {
  double last = infinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = direction[axis];
    if (d != 0.0) last = std::min(last, ((d > 0.0 ? upper[axis] : lower[axis]) - origin[axis]) / d);
  }
  constexpr double rounding = 1e-9;
  return last + rounding * (1.0 + std::abs(last) + origin.cwiseAbs().maxCoeff());
}

}  // namespace cohort::geometry
