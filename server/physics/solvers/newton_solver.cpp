#include "server/physics/solvers/newton_solver.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::physics {
namespace {

constexpr int most_steps = 30;  // steps of Newton's method, in all minima together

// A limit of friction may still change by this multiple of the negligible error, as it would change the velocity of a
// free body.
constexpr double limits_tolerance = 100.0;

}  // namespace

bool NewtonSolver::solve(Problem& problem, double negligible, int most_minima) {
  if (!take_bodies(problem)) return false;
  rows_.gather(problem);
  start_with_impulses();
  rows_.guess_loads([this](const Row& row) { return along(row, velocity_); });
  if (!rows_.are_settled(0.1 * negligible) && !(take_inertia() && follow(negligible, most_minima))) return false;
  apply();
  return true;
}

// Finds minima until the rows do not yield any more. Returns false if it does not even find the first.
bool NewtonSolver::follow(double negligible, int most_minima) {
  int steps_left = most_steps;
  for (int minimum = 0; minimum < most_minima; ++minimum) {
    double moved = 0.0;
    if (!minimise(negligible, steps_left, moved)) {
      velocity_ = found_;
      return minimum > 0;
    }
    found_ = velocity_;
    const double yielded = rows_.update_guesses();
    const double limits = rows_.update_limits();
    if (minimum > 0 && moved <= negligible) return true;
    if (yielded <= negligible && limits <= limits_tolerance * negligible) return true;
  }
  return true;
}

// Returns false if no minimum was found in the steps that are left.
bool NewtonSolver::minimise(double negligible, int& steps_left, double& moved) {
  bool is_whole = false;
  for (; steps_left > 0; --steps_left) {
    const bool is_same = evaluate();
    if (is_whole && is_same) return true;
    if (!is_same) factorise();
    find_step();
    double greatest = 0.0;
    for (const YieldingRow& term : rows_.terms())
      for (std::size_t i = 0; i < term.count; ++i) greatest = std::max(greatest, std::abs(term.change[i]));
    moved = std::max(moved, greatest);
    const bool is_last = greatest <= negligible;
    double curvature = 0.0;
    const double share = is_last ? 1.0 : find_share(slope(0.0, &curvature));
    add_step(share);
    if (is_last) {
      evaluate();
      return true;
    }
    is_whole = share == 1.0;
  }
  return false;
}

}  // namespace cohort::physics
