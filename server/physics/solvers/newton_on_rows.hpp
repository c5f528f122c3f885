// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/physics/solvers/block_cholesky.hpp"
#include "server/physics/solvers/convex_rows.hpp"

namespace cohort::physics {

/// Newton's method for the velocities of the bodies of an island, where the impulses of the rows are functions of these
/// velocities. The matrix of a step is the mass matrix plus the stiffness of the rows.
///
/// Reuses its memory.
class NewtonOnRows {
 protected:
  /// Starts with the bodies of a problem, which must outlive this.
  void take_bodies(Problem& problem);
  /// Sets up the matrix from the couplings and the inertia of the bodies. Returns false if a factorisation would cost
  /// too much.
  bool take_inertia();
  /// Starts from the velocities with the present impulses of the terms.
  void start_with_impulses();

  /// Computes all impulses and their stiffnesses. Returns whether the present factors belong to these stiffnesses.
  bool evaluate();
  void factorise();
  /// Computes the Newton step, which would satisfy the equations if they were linear.
  void find_step();
  /// Returns the fraction of the step that minimises the convex function (exact line search). `first_slope`: derivative
  /// of the function along the step at the start.
  double find_share(double first_slope);
  /// Returns the derivative of the function along the step, at the fraction `share` of the step. Writes the second
  /// derivative to `curvature`.
  double slope(double share, double* curvature);
  void add_step(double share);
  /// Writes impulses and velocities to the problem.
  void apply();

  void multiply_by_inertia(const std::vector<double>& velocities, std::vector<double>& momenta) const;
  double along(const Row& row, const std::vector<double>& velocities) const;
  /// Calls `visit(offset, jacobian, stride)` for each body of a row; the response is `stride` elements after the
  /// Jacobian.
  template <class Visit>
  void for_each_body(const Row& row, Visit&& visit) const;
  std::ptrdiff_t length() const { return static_cast<std::ptrdiff_t>(matrix_.length()); }

  // NOLINTBEGIN(misc-non-private-member-variables-in-classes): a solver derives from this to work on them.
  Problem* problem_ = nullptr;
  ConvexRows rows_;
  BlockCholesky matrix_;
  std::vector<int> sizes_;          // by body
  std::vector<double> inertia_;     // mass matrices
  std::vector<std::size_t> begin_;  // start of each body's mass matrix
  std::vector<double> velocity_;    // vectors in the layout of matrix_
  std::vector<double> momentum_;    // momentum added by impulses so far
  std::vector<double> missing_;     // impulses of the rows as momentum, minus momentum_
  std::vector<double> step_;        // step of the velocity
  std::vector<double> step_momentum_;
  bool is_factorised_ = false;
  // NOLINTEND(misc-non-private-member-variables-in-classes)

 private:
  void add_outer_products(const ConvexTerm& term);
};

template <class Visit>
void NewtonOnRows::for_each_body(const Row& row, Visit&& visit) const {
  const double* numbers = problem_->numbers() + row.numbers;
  visit(matrix_.offset(row.body_a), numbers, row.stride_a);
  if (row.body_b >= 0) visit(matrix_.offset(row.body_b), numbers + 2 * row.stride_a, row.stride_b);
}

}  // namespace cohort::physics
