// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace cohort {

/// Returns whether a direction or a quaternion has length 1, up to rounding. For assertions.
template <class Vector>
bool is_unit(const Vector& v) {
  constexpr double rounding = 1e-9;
  return std::abs(v.squaredNorm() - 1.0) < rounding;
}

}  // namespace cohort
