#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "server/physics/solvers/newton_on_rows.hpp"
#include "server/physics/world/convergence.hpp"

namespace cohort::physics {

/// Solves all rows of an island at once, until they are satisfied.
///
/// The unknowns are the velocities v at the end of the step. With given guesses and limits of friction, they are the
/// minimum of a convex function. It is half the square of their distance from the velocities without impulses, measured
/// by the mass matrix, plus a term for each row (ConvexRows). Newton's method with an exact line search finds it.
/// Source: Castro, Permenter and Han, "An unconstrained convex formulation of compliant contact", IEEE Transactions on
/// Robotics 39, 2023. Friction with the limits of given loads: Castro, Han and Masterjohn, "Irrotational contact
/// fields", arXiv 2312.03908, 2023.
///
/// The impulses at the minimum are the guesses of the next one, so that the rows yield less and less. This is the
/// method of multipliers (Rockafellar, "Augmented Lagrangians and applications of the proximal point algorithm in
/// convex programming", Mathematics of Operations Research 1, 1976). The limits of friction follow the loads from
/// minimum to minimum. The impulses of the last step only tell with which limits to begin, and which rows are probably
/// at them.
///
/// Reuses its memory; each worker has one.
class ConvexSolver : private NewtonOnRows {
 public:
  /// Solves the rows. The error of the outcome is the residual when the last minimum was tested: the change of the
  /// velocities that new guesses and limits would make. It is a share of what forces and impulses change. Both are
  /// measured by the mass matrix, so that the residual does not depend on units, masses, sizes or gravity. Returns
  /// nothing, without any change, if the response of a body is not symmetric or if a factorisation would cost too much.
  /// It does the same after more than `most_steps` of Newton's method.
  std::optional<Convergence::Outcome> solve(Problem& problem, std::uint32_t most_steps = unlimited_steps);

  static constexpr std::uint32_t unlimited_steps = std::numeric_limits<std::uint32_t>::max();

 private:
  /// Where the search for a minimum begins. `velocities`: at the present ones. `impulses`: with each row at or between
  /// its limits, as its present impulse is. `step`: with a step that was already found.
  enum class From { velocities, impulses, step };

  void start();
  void minimise(From from);
  double settle();
  bool is_near() const;
  double share_of_change(const std::vector<double>& momentum) const;

  std::vector<std::vector<double>> diagonals_;  // by body: diagonal of its mass matrix
  std::vector<double> without_impulses_;        // velocities
  Convergence::Outcome outcome_;
  std::uint32_t most_steps_ = unlimited_steps;
  double by_forces_ = 0.0;  // square of what forces change, measured by the mass matrix
};

}  // namespace cohort::physics
