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
  double compliance = 0.0;  ///< velocity by which the row yields to a unit impulse beyond its guess
  double softness = 0.0;    ///< that the row itself has
  std::array<double, 2> guess{};
  bool has_guess = false;            ///< friction, a motor or the like
  std::array<double, 2> velocity{};  ///< along each row
  std::array<double, 2> change{};    ///< change of the velocity by a whole step
  std::array<double, 2> impulse{};
  std::array<double, 3> stiffness{};             ///< negative derivative of the impulse: first, second, mixed
  std::array<double, 3> factorised{};            ///< the stiffness in the present factors
  std::array<BlockCholesky::Block, 3> blocks{};  ///< first body, second body, both
};

/// The rows of a problem as functions of the velocities. The impulse of a row is a guess plus (target - velocity) /
/// compliance, within the row's limits. It is the negative derivative of a convex function. Limits of friction are
/// those of the loads when they were last updated.
///
/// The compliance is a share of what the heaviest body of the island yields to the same impulse, so that it does not
/// depend on units, masses or sizes. All guesses are zero at first. Loads that statics leaves open are therefore shared
/// as by equal springs, and they depend on the present state alone.
///
/// Reuses its memory.
class ConvexRows {
 public:
  /// Takes the rows of `problem`, which must outlive this. The limits of friction are those of the loads in the last
  /// step; new contacts have the loads that would stop the bodies. `inertia`: by body, the diagonal of its mass matrix.
  void gather(Problem& problem, const std::vector<std::vector<double>>& inertia);

  std::vector<ConvexTerm>& terms() { return terms_; }
  const std::vector<ConvexTerm>& terms() const { return terms_; }
  const Row& row(const ConvexTerm& term, std::size_t i = 0) const { return problem_->rows()[term.row + i]; }

  /// Computes the impulse at a share of the change of the velocity, and its derivative.
  void evaluate(ConvexTerm& term, double share) const;
  /// Computes the impulse as if the row were within its limits or at one, as its present impulse is.
  void extend(ConvexTerm& term) const;
  /// Takes the present impulses as guesses, and moves the limits of friction by this share of the way to those of the
  /// present loads.
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
  std::vector<std::vector<double>> yielding_;  // by body and dof, as in ConvexTerm
  double yielding_to_force_ = 0.0;             // 1 / mass of the heaviest body
};

}  // namespace cohort::physics
