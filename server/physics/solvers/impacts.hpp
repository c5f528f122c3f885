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
/// Reuses its memory; each worker has one.
class Impacts {
 public:
  /// Changes the velocities by the impacts, if there are any. The rows keep the impulses with which they start.
  void solve(Problem& problem);
  /// Adds the impulses of the impacts to those of the rows; call it after the rows have been solved.
  void add_impulses(Problem& problem) const;

 private:
  bool find_approaching(Problem& problem);
  void solve_round(Problem& problem);

  std::vector<Row> rows_;         // as they were before the impacts
  std::vector<double> impulses_;  // sum over the rounds, by row; empty: no impact
  std::vector<double> free_;      // velocity changes by forces, by body and dof
};

/// Makes the contacts that approach each other rebound in the same solution as everything else. For islands that are
/// too large for rounds.
void rebound_at_once(Problem& problem);

}  // namespace cohort::physics
