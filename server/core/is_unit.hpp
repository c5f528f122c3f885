// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace cohort {

/// Returns whether a direction or a quaternion has length 1, up to rounding. For assertions: true for numbers that are
/// not finite, since these are found at the end of a step.
template <class Vector>
bool is_unit(const Vector& v) {
  constexpr double rounding = 1e-9;
  const double error = std::abs(v.squaredNorm() - 1.0);
  return !(error >= rounding && std::isfinite(error));
}

}  // namespace cohort
