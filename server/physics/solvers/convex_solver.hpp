#pragma once

#include <vector>

#include "server/physics/multibody/rows.hpp"
#include "server/physics/solvers/block_cholesky.hpp"
#include "server/physics/solvers/convex_rows.hpp"

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
class ConvexSolver {
 public:
  /// Solves the rows. Returns false, without any change, if the response of a body is not symmetric or if it would cost
  /// too much.
  bool solve(Problem& problem);

 private:
  /// How the search for a minimum starts: with the present impulses, with those of rows that stay at their limits or
  /// between them, or with a step that is known.
  enum class Start { present, predicted, step };

  bool prepare(Problem& problem);
  void start();
  void take_inertia();
  bool minimise(Start start, int most_steps);
  bool evaluate();
  bool is_near() const;
  void find_gradient();
  void factorise();
  void add_outer_products(const ConvexTerm& term);
  void find_step();
  /// Returns the step that is to be made, as a share of all that forces and impulses change. Both are measured by the
  /// mass matrix with the stiffness of the rows, so that it does not depend on units, masses, sizes or gravity.
  double find_residual() const;
  double slope(double share, double* curvature);
  double find_share();
  void add_step(double share);
  void apply();
  void multiply_by_inertia(const std::vector<double>& velocities, std::vector<double>& momenta) const;
  double along(const Row& row, const std::vector<double>& velocities) const;
  template <class Visit>
  void for_each_body(const Row& row, Visit&& visit) const;

  Problem* problem_ = nullptr;
  ConvexRows rows_;
  BlockCholesky matrix_;
  std::vector<int> sizes_;                      // by body
  std::vector<double> inertia_;                 // mass matrices
  std::vector<std::size_t> begin_;              // start of each body's mass matrix
  std::vector<std::vector<double>> diagonals_;  // by body: diagonal of its mass matrix
  std::vector<double> without_impulses_;        // velocities; vectors as in the matrix
  std::vector<double> velocity_;
  std::vector<double> momentum_;  // that the impulses have added
  std::vector<double> gradient_;  // gradient of the function
  std::vector<double> step_;      // step of the velocity
  std::vector<double> step_momentum_;
  double by_forces_ = 0.0;  // square of what forces change, measured by the mass matrix
  bool is_factorised_ = false;
};

}  // namespace cohort::physics
