// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/physics/multibody/rows.hpp"

namespace cohort::physics {

/// Solves all rows at once by Dantzig's algorithm for linear complementarity problems (Baraff, "Fast contact force
/// computation for nonpenetrating rigid bodies", SIGGRAPH 1994), as in the thesis's exact solver. The result does not
/// depend on an initial guess, and the cost grows with the third power of the number of rows. Friction is a pyramid,
/// not a cone. Its two directions are limited separately by the normal impulses of the previous solution; a few
/// solutions are made.
///
/// Returns false, without any change, if the algorithm finds no solution.
bool solve_directly(Problem& problem);

}  // namespace cohort::physics
