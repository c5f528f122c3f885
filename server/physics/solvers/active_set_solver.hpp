#pragma once

#include "server/physics/multibody/rows.hpp"

namespace cohort::physics {

/// Solves the problem of one body with few rows exactly by an active-set method. It guesses which rows are at a limit,
/// starting with those of the last step, and solves the others as linear equations. The guess is corrected until every
/// row agrees with it. For a robot that drives freely, the first guess is usually right. The cost is then that of one
/// or two passes of the iterative solver.
///
/// Returns false, without any change, if the problem is not of that kind (several bodies, friction in a disc, many
/// rows) or no guess was right. The iterative solver accepts all problems.
bool solve_by_active_set(Problem& problem);

}  // namespace cohort::physics
