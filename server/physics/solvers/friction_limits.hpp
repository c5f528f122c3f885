// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "server/physics/multibody/rows.hpp"

namespace cohort::physics {

/// Relaxation factor of friction limits. A solver with constant friction limits updates them from the loads of its last
/// solution and solves again. Without relaxation, limits may alternate for many solutions.
inline constexpr double share_of_limits = 0.6;

/// Returns the load on a friction row, the sum of the impulses of its normal rows [N s]. `impulse_of(i)`: impulse of
/// row i.
template <class ImpulseOf>
double load_on(const Row& row, ImpulseOf&& impulse_of) {
  double load = 0.0;
  for (int i = row.load_begin; i < row.load_end; ++i) load += impulse_of(static_cast<std::size_t>(i));
  return load;
}

/// Returns the greatest impulse of a friction row under a load [N s].
inline double limit_of_friction(const Row& row, double load) {
  return std::max(0.0, std::min(row.cap, row.friction * load));
}

}  // namespace cohort::physics
