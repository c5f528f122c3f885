#pragma once

#include <cstdint>
#include <vector>

#include "server/core/ids.hpp"

namespace cohort::physics {

/// How well the convex solver has solved the joints and contacts of islands, groups of bodies that touch or are
/// connected. The error of an island is the step to velocities that would fit all rows better, as a share of what
/// forces and impulses change in the step. Both are measured by the mass matrix. So it depends on neither units, masses
/// nor sizes.
struct Convergence {
  /// Islands with a greater error have not converged.
  static constexpr double bound = 1e-6;

  struct Island {
    BodyId body;  ///< its first body
    double error = 0.0;
  };

  std::uint64_t solved = 0;          ///< islands since the world was built, counted in each step
  std::uint64_t unconverged = 0;     ///< number of them that have not converged
  double worst = 0.0;                ///< greatest error of those
  std::vector<Island> of_last_step;  ///< islands that have not converged in the last step, by their first body
};

}  // namespace cohort::physics
