#pragma once

#include <algorithm>
#include <cstddef>

#include "server/physics/multibody/rows.hpp"

namespace cohort::physics {

/// Limits of friction follow from the loads of the last solution, again and again. If they have not settled soon, they
/// move by this share of the way: with the whole way, limits that alternate would do so for long.
inline constexpr double share_of_limits = 0.6;

/// Returns the load on a row of friction, if `impulse_of(i)` is the impulse of row i.
template <class ImpulseOf>
double load_on(const Row& row, ImpulseOf&& impulse_of) {
  double load = 0.0;
  for (int i = row.load_begin; i < row.load_end; ++i) load += impulse_of(static_cast<std::size_t>(i));
  return load;
}

/// Returns the limit of a row of friction under a load.
inline double limit_of_friction(const Row& row, double load) {
  return std::max(0.0, std::min(row.cap, row.friction * load));
}

}  // namespace cohort::physics
