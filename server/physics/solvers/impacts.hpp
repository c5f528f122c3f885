#pragma once

#include <vector>

#include "server/physics/multibody/rows.hpp"

namespace cohort::physics {

/// Solves the impacts of one island: contacts with restitution whose bodies approach each other. It does so before the
/// forces of the step act, in rounds. In each round, the bodies of all contacts that now approach each other rebound at
/// once, while contacts with restitution whose bodies do not approach have no effect. An impact thus travels through a
/// row of touching balls from contact to contact, and only the last ball leaves. Source: Smith, Kaufman, Vouga,
/// Tamstorf and Grinspun, "Reflections on simultaneous impact", ACM Transactions on Graphics 31, 2012.
///
/// A contact rebounds at the beginning of the step, although its bodies touch within it. Their energy after it is right
/// for that place. The velocity that the restitution reduces includes what they gain on their way through the gap, and
/// they lose that again on the way back. Velocities belong to the middle of a step, as in the leapfrog method. So a
/// ball rises to the same height at any step.
///
/// Reuses its memory; each worker has one.
class Impacts {
 public:
  /// Changes the velocities by the impacts, if there are any. The rows keep the impulses with which they start. `fall`:
  /// speed that gravity adds in a step [m/s]. Other forces may change within the step, so that more is not counted.
  void solve(Problem& problem, double fall);
  /// Adds the impulses of the impacts to those of the rows; call it after the rows have been solved.
  void add_impulses(Problem& problem) const;

 private:
  bool find_approaching(Problem& problem);
  void solve_round(Problem& problem);

  std::vector<Row> rows_;         // as they were before the impacts
  std::vector<double> impulses_;  // sum over the rounds, by row; empty: no impact
  std::vector<double> free_;      // velocity changes by forces, by body and dof
  std::vector<double> gained_;    // along each row, no more than by gravity
};

/// Makes the contacts that approach each other rebound in the same solution as everything else. For islands that are
/// too large for rounds. Call it before any impulses are applied.
void rebound_at_once(Problem& problem, double fall);

}  // namespace cohort::physics
