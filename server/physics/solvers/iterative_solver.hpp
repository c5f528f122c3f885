// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/physics/multibody/rows.hpp"

namespace cohort::physics {

/// The iterative solver ends after a pass that changes no row's velocity by more than this [m/s or rad/s].
inline constexpr double negligible_change = 1e-9;

/// Sequential impulses (projected Gauss-Seidel), warm-started with the impulses of the last step. Changes the impulses
/// in the rows and the velocities of the bodies.
class SequentialImpulses {
 public:
  /// Takes the rows that the problem has now; the problem must outlive this.
  explicit SequentialImpulses(Problem& problem) : rows_(problem.rows()), numbers_(problem.numbers()) {}

  /// Applies this share of the last step's impulses; call it once before the first pass.
  void start(double share);
  /// Makes one pass over the rows, forwards or backwards. Returns the greatest change of a row's velocity.
  double pass(bool forwards);
  /// Makes one pass over the rows that are not friction, and returns the same.
  double pass_without_friction(bool forwards);

 private:
  double turn(std::size_t index);
  double turn_cone(Row& first, Row& second);
  double limit_of(const Row& row) const;
  double velocity(const Row& row) const;
  double wanted(const Row& row) const;
  double change(Row& row, double impulse);
  void apply(const Row& row, double impulse);

  std::vector<Row>& rows_;
  const double* numbers_;
};

/// Share of the last impulses with which an island with connections is warm-started. If the passes end before
/// convergence, the remaining errors would otherwise accumulate from step to step: light links between heavy ones would
/// gain energy without bound.
inline constexpr double start_of_connected = 0.9;

/// The number of passes: `least`, unless nothing changes any more. More passes follow, up to `most_times` times `least`
/// in total, as long as a pass changes the velocity of a row by more than `settled` [m/s or rad/s].
struct Passes {
  std::uint32_t least = 0;
  std::uint32_t most_times = 1;
  double settled = 0.0;
  double share_of_last = 1.0;  ///< share of the last step's impulses for the warm start
};

/// Makes passes in alternating directions. `pass(forwards)` returns the greatest change of a row's velocity.
template <class Pass>
void make_passes(const Passes& passes, Pass&& pass) {
  for (std::uint32_t i = 0; i < passes.most_times * passes.least; ++i)
    if (pass(i % 2 == 0) <= (i + 1 < passes.least ? negligible_change : passes.settled)) break;
}

}  // namespace cohort::physics
