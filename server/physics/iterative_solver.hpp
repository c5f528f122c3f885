#pragma once

#include "server/physics/rows.hpp"

namespace cohort::physics {

/// Sequential impulses (projected Gauss-Seidel), started from the impulses of the last step. Ends after `iterations`
/// passes over the rows, or earlier when a pass changed no row's velocity by more than `tolerance` [m/s or rad/s].
/// Leaves the impulses in the rows and the bodies' velocities changed by them. Returns the passes made.
int solve_iteratively(Problem& problem, std::uint32_t iterations, double tolerance);

}  // namespace cohort::physics
