#pragma once

#include "server/physics/multibody/rows.hpp"

namespace cohort::physics {

/// Dantzig's algorithm for linear complementarity problems on all rows at once (Baraff, "Fast contact force computation
/// for nonpenetrating rigid bodies", SIGGRAPH 1994), as in the thesis's exact solver: independent of any start, and its
/// cost grows with the third power of the number of rows. Friction is a pyramid, not a cone: its two directions are
/// limited each for itself, by the normal impulses of the solution before, of which there are a few.
///
/// False, and nothing changed, if the algorithm finds no solution.
bool solve_directly(Problem& problem);

}  // namespace cohort::physics
