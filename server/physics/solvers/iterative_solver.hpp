#pragma once

#include "server/physics/multibody/rows.hpp"

namespace cohort::physics {

/// A pass that changes no row's velocity by more ends the iterative solver [m/s or rad/s].
inline constexpr double negligible_change = 1e-9;

/// Sequential impulses (projected Gauss-Seidel), started from the impulses of the last step. Leaves the impulses in the
/// rows and the bodies' velocities changed by them.
class SequentialImpulses {
 public:
  /// For the rows that the problem has now; it must outlive this.
  explicit SequentialImpulses(Problem& problem) : rows_(problem.rows()), numbers_(problem.numbers()) {}

  /// Once, before the first pass: from this share of the last step's impulses.
  void start(double share);
  /// Takes the impulses out of the velocities, or puts them in again.
  void take_back();
  void put_in();
  /// One pass over the rows, forwards or backwards. Returns the greatest change of a row's velocity.
  double pass(bool forwards);

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

/// What an island with connections starts from. Where passes end before the impulses are right, what is wrong with them
/// would otherwise add up from step to step: light links between heavy ones then gain energy without end.
inline constexpr double start_of_connected = 0.9;

/// At most `iterations` passes, there and back. Returns the greatest change of a row's velocity by the last one.
double solve_iteratively(Problem& problem, std::uint32_t iterations, double share_of_last);

}  // namespace cohort::physics
