#pragma once

#include "server/physics/multibody/rows.hpp"

namespace cohort::physics {

/// Solves the problem of one body with few rows exactly: guesses which rows are at a limit, at first those that were so
/// in the last step, solves the others as linear equations, and mends the guess until every row agrees with it. For a
/// robot that drives freely the first guess is right most of the time, and the whole costs as much as one or two passes
/// of the iterative solver.
///
/// False, and nothing changed, if the problem is not of that kind (several bodies, friction in a disc, many rows) or
/// no guess held; the iterative solver takes all problems.
bool solve_by_active_set(Problem& problem);

}  // namespace cohort::physics
