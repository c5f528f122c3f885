#pragma once

#include <vector>

#include "server/physics/multibody/rows.hpp"
#include "server/physics/solvers/newton_on_rows.hpp"
#include "server/physics/solvers/yielding_rows.hpp"

namespace cohort::physics {

/// Solves all rows of an island at once, until they are satisfied. Unlike sequential impulses it leaves no error that
/// depends on the order of the rows or grows with the height of a heap.
///
/// The unknowns are the velocities. Each row yields a little: its impulse is a first guess plus (target - velocity) /
/// compliance, within the row's limits. The velocities with these impulses are the minimum of a convex function, which
/// Newton's method finds with a line search. Sources: Todorov, "Convex and analytically-invertible dynamics with
/// contacts and constraints", ICRA 2014; Castro, Permenter and Han, "An unconstrained convex formulation of compliant
/// contact", IEEE Transactions on Robotics 39, 2023. These two couple friction to the normal velocity, which lifts a
/// body that slides. Here the limits of friction are constant in each minimum.
///
/// The impulses at the minimum are the next guess, and their loads give the next limits of friction, until the rows do
/// not yield any more. This is the method of multipliers (Bertsekas, "Constrained optimization and Lagrange multiplier
/// methods", 1982, chapters 2 and 5). The first guess is that of the last step, which usually solves a heap at rest.
///
/// Reuses its memory; each worker has one.
class NewtonSolver : private NewtonOnRows<YieldingRows> {
 public:
  /// Returns false, without any change, if it would cost too much or no minimum was found. `negligible`: an error of
  /// the velocity of a row that does not matter [m/s or rad/s]. `most_minima`: how many of them are found at most; the
  /// first has an error of about a hundredth of what the impulses change.
  bool solve(Problem& problem, double negligible, int most_minima = usual_minima);
  static constexpr int usual_minima = 10;

 private:
  bool follow(double negligible, int most_minima);
  bool minimise(double negligible, int& steps_left, double& moved);

  std::vector<double> found_;  // the velocity at the last minimum
};

}  // namespace cohort::physics
