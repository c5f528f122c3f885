// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "server/core/ids.hpp"

namespace cohort::physics {

/// Statistics of how well the convex solver has solved the joints and contacts of islands, groups of bodies that touch
/// or are connected. The error of an island is the residual velocity change of its last solution, relative to the
/// velocity change by forces and impulses in the step. Both are in the norm of the mass matrix, so that the error does
/// not depend on units, masses or sizes.
struct Convergence {
  /// Islands with a greater error have not converged.
  static constexpr double bound = 1e-6;

  struct Island {
    BodyId body;  ///< its first body
    double error = 0.0;
  };

  /// How one island was solved in one step.
  struct Outcome {
    double error = 0.0;
    std::uint32_t minima = 0;          ///< minima found, each with given limits of friction
    std::uint32_t steps = 0;           ///< steps of Newton's method to these minima
    std::uint32_t factorisations = 0;  ///< matrices factorised for these steps
  };

  std::uint64_t solved = 0;          ///< islands since the world was built, counted in each step
  std::uint64_t unconverged = 0;     ///< number of them that have not converged
  double worst = 0.0;                ///< greatest error of those
  std::uint64_t minima = 0;          ///< sum over the islands that were solved
  std::uint64_t steps = 0;           ///< sum over these islands
  std::uint64_t factorisations = 0;  ///< sum over these islands
  std::uint32_t most_minima = 0;     ///< for one island
  std::vector<Island> of_last_step;  ///< islands that have not converged in the last step, by their first body
};

}  // namespace cohort::physics
