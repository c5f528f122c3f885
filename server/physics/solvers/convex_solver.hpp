// SPDX-License-Identifier: Apache-2.0
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
/// The unknowns are the velocities v at the end of the step. For given guesses and friction limits, they minimise a
/// convex function. The function is half the squared distance from the velocities without impulses, in the norm of the
/// mass matrix, plus a term for each row (ConvexRows). Newton's method with an exact line search finds the minimum.
/// Source: Castro, Permenter and Han, "An unconstrained convex formulation of compliant contact", IEEE Transactions on
/// Robotics 39, 2023. Friction limits from given loads: Castro, Han and Masterjohn, "Irrotational contact fields",
/// arXiv 2312.03908, 2023.
///
/// The impulses at a minimum are the guesses for the next one, so that the effect of the compliance vanishes. This is
/// the method of multipliers (Rockafellar, "Augmented Lagrangians and applications of the proximal point algorithm in
/// convex programming", Mathematics of Operations Research 1, 1976). The friction limits follow the loads from minimum
/// to minimum. The impulses of the last step only determine the initial limits, and which rows are probably at a limit.
///
/// Reuses its memory; each worker has one.
class ConvexSolver : private NewtonOnRows {
 public:
  /// Solves the rows. The error of the outcome is the residual after the last minimum: the velocity change that new
  /// guesses and limits would cause, relative to that by forces and impulses. Both are in the norm of the mass matrix,
  /// so that the residual does not depend on units, masses, sizes or gravity. Returns nothing, without any change, if
  /// no body can move or the response of a body is not symmetric. It does the same if a factorisation would cost too
  /// much or Newton's method takes more than `most_steps`.
  std::optional<Convergence::Outcome> solve(Problem& problem, std::uint32_t most_steps = unlimited_steps);

  static constexpr std::uint32_t unlimited_steps = std::numeric_limits<std::uint32_t>::max();

 private:
  /// The start of the search for a minimum. `velocities`: the present velocities. `impulses`: the prediction of
  /// ConvexRows::extend. `step`: a Newton step that was already computed.
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
  double by_forces_ = 0.0;  // squared velocity change by forces, in the norm of the mass matrix
};

}  // namespace cohort::physics
