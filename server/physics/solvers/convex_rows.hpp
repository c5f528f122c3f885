// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "server/physics/multibody/rows.hpp"
#include "server/physics/solvers/block_cholesky.hpp"
#include "server/physics/solvers/friction_limits.hpp"

namespace cohort::physics {

/// A row, or the two rows of a friction disc, whose impulse is a function of the velocity along it.
struct ConvexTerm {
  std::size_t row = 0;
  std::size_t count = 1;  ///< number of rows
  double lower = 0.0;
  double upper = 0.0;       ///< radius of a disc
  double compliance = 0.0;  ///< velocity change by a unit impulse beyond the guess
  double softness = 0.0;    ///< compliance of the row itself, Row::softness
  std::array<double, 2> guess{};
  bool has_guess = false;            ///< the guess follows the impulse: friction, a motor or the like
  std::array<double, 2> velocity{};  ///< along each row
  std::array<double, 2> change{};    ///< change of the velocity by a full Newton step
  std::array<double, 2> impulse{};
  std::array<double, 3> stiffness{};             ///< -d(impulse)/d(velocity): first, second, mixed
  std::array<double, 3> factorised{};            ///< the stiffness in the present factors
  std::array<BlockCholesky::Block, 3> blocks{};  ///< first body, second body, both
};

/// The rows of a problem as functions of the velocities. The impulse of a row is a guess plus (target - velocity) /
/// compliance, within the row's limits. It is the negative derivative of a convex function. Friction limits follow from
/// the loads at the last `update`.
///
/// The compliance is at most a fixed fraction of the velocity change of the heaviest body of the island by a unit
/// impulse. The fraction suits any units, masses and sizes. All guesses are zero at first. Statically indeterminate
/// loads are therefore shared as by equal springs, and depend on the present state alone.
///
/// Reuses its memory.
class ConvexRows {
 public:
  /// Takes the rows of `problem`, which must outlive this. Friction limits follow from the loads in the last step, or
  /// for new contacts, from the loads that would stop the bodies. `inertia`: by body, the diagonal of its mass matrix.
  void gather(Problem& problem, const std::vector<std::vector<double>>& inertia);

  std::vector<ConvexTerm>& terms() { return terms_; }
  const std::vector<ConvexTerm>& terms() const { return terms_; }
  const Row& row(const ConvexTerm& term, std::size_t i = 0) const { return problem_->rows()[term.row + i]; }

  /// Computes the impulse and its stiffness at the velocity after the fraction `share` of the Newton step.
  void evaluate(ConvexTerm& term, double share) const;
  /// Predicts the impulse and its stiffness: a row at a limit stays there, and a row between its limits is not clamped.
  void extend(ConvexTerm& term) const;
  /// Uses the present impulses as guesses, and moves the friction limits by the fraction `share` of the way to those of
  /// the present loads.
  void update(double share);
  /// Writes impulses and limits to the rows of the problem.
  void apply();

 private:
  void set_compliance(ConvexTerm& term);
  void guess_limit(ConvexTerm& term);
  double wanted(const ConvexTerm& term, std::size_t i, double share) const;
  double load_of(const Row& row) const;

  Problem* problem_ = nullptr;
  std::vector<ConvexTerm> terms_;
  std::vector<double> impulses_;               // by row of the problem
  std::vector<std::vector<double>> yielding_;  // by body and dof: yielding_to_force_ / square of the radius of gyration
  double yielding_to_force_ = 0.0;             // 1 / mass of the heaviest body
};

}  // namespace cohort::physics
