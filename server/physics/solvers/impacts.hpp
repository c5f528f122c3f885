// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/physics/multibody/rows.hpp"

namespace cohort::physics {

/// Solves the impacts of one island: contacts with restitution whose bodies approach each other. It solves them in
/// rounds, before the forces of the step act. In each round, all contacts whose bodies approach each other rebound at
/// once, and other contacts with restitution have no effect. An impact thus travels from contact to contact through a
/// row of touching balls, and only the last ball leaves. Source: Smith, Kaufman, Vouga, Tamstorf and Grinspun,
/// "Reflections on simultaneous impact", ACM Transactions on Graphics 31, 2012.
///
/// A contact rebounds at the beginning of the step, although its bodies touch only during the step. The rebound
/// velocity gives the bodies the right energy for their positions at the beginning. Restitution applies to the velocity
/// at touch, which includes the velocity gained in the gap. The energy gained in the gap is lost again on the way back.
/// Velocities belong to the middle of a step, as in the leapfrog method. A ball therefore rises to the same height with
/// any step size.
///
/// Reuses its memory; each worker has one.
class Impacts {
 public:
  /// Changes the velocities by the impacts, if there are any. The rows keep their warm-start impulses. `fall`: speed
  /// that gravity adds in a step [m/s]. Velocity gained during the step counts only up to `fall`, since other forces
  /// may change within the step.
  void solve(Problem& problem, double fall);
  /// Adds the impulses of the impacts to those of the rows; call it after the rows have been solved.
  void add_impulses(Problem& problem) const;

 private:
  bool find_approaching(Problem& problem);
  void solve_round(Problem& problem);

  std::vector<Row> rows_;         // as they were before the impacts
  std::vector<double> impulses_;  // sum over the rounds, by row; empty: no impact
  std::vector<double> free_;      // velocity changes by forces, by body and dof
  std::vector<double> gained_;    // by row: velocity gained during the step, at most by gravity
};

/// Sets the target velocities of approaching contacts with restitution, so that they rebound in the common solution of
/// all rows. For islands that are too large for rounds. Call it before any impulses are applied. `fall`: as in
/// Impacts::solve.
void rebound_at_once(Problem& problem, double fall);

}  // namespace cohort::physics
