#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "server/physics/multibody/rows.hpp"
#include "server/physics/solvers/block_cholesky.hpp"

namespace cohort::physics {

/// Solves all rows of an island at once, until they are satisfied. Unlike sequential impulses it leaves no error that
/// depends on the order of the rows or grows with the height of a heap.
///
/// The unknowns are the velocities. Each row yields a little: its impulse is a first guess plus (target - velocity) /
/// compliance, within the row's limits. The velocities with these impulses are the minimum of a convex function, which
/// Newton's method finds with a line search. Sources: Todorov, "Convex and analytically-invertible dynamics with
/// contacts and constraints", ICRA 2014; Castro, Permenter and Han, "An unconstrained convex formulation of compliant
/// contact", IEEE Transactions on Robotics 39, 2023. These two couple friction to the normal velocity, which lifts a
/// body that slides. Here the limits of friction are constant in each minimum.
///
/// The impulses at the minimum are the next guess, and their loads give the next limits of friction, until the rows do
/// not yield any more. This is the method of multipliers (Bertsekas, "Constrained optimization and Lagrange multiplier
/// methods", 1982, chapters 2 and 5). The first guess is that of the last step, which usually solves a heap at rest.
///
/// Reuses its memory; each worker has one.
class NewtonSolver {
 public:
  /// Returns false, without any change, if it would cost too much or no minimum was found. `negligible`: an error of
  /// the velocity of a row that does not matter [m/s or rad/s].
  bool solve(Problem& problem, double negligible);

 private:
  /// A row, or the two rows of a cone.
  struct Term {
    std::size_t row = 0;
    std::size_t count = 1;  ///< number of rows
    bool is_free = false;   ///< the impulse is within its limits
    double compliance = 0.0;
    double forgotten = 0.0;  ///< share of the impulse that is missing in the next guess
    double lower = 0.0;
    double upper = 0.0;                ///< radius of a cone
    std::array<double, 2> guess{};     ///< guess of the impulse
    std::array<double, 2> velocity{};  ///< along each row
    std::array<double, 2> change{};    ///< change of the velocity by a whole step
    std::array<double, 2> impulse{};
    std::array<double, 3> stiffness{};             ///< negative derivative of the impulse: first, second, mixed
    std::array<double, 3> factorised{};            ///< the stiffness in the present factors
    std::array<BlockCholesky::Block, 3> blocks{};  ///< first body, second body, both
  };

  bool is_small(const Problem& problem);
  void gather();
  void soften(Term& term, double response, double least);
  void start();
  void guess_loads();
  bool is_settled(double negligible) const;
  bool prepare();
  bool follow(double negligible);
  bool minimise(double negligible, int& steps_left, double& moved);
  bool evaluate();
  void evaluate(Term& term, double share) const;
  void factorise();
  void add_outer_products(const Term& term);
  double find_step();
  double slope(double share, double* curvature);
  double find_share();
  void add_step(double share);
  double update_limits();
  double update_guesses();
  void apply();

  const Row& row(const Term& term, std::size_t i = 0) const { return problem_->rows()[term.row + i]; }
  double along(const Row& row, const std::vector<double>& velocities) const;
  static double response_of(const Row& row);
  double response_of_heavier(const Row& row, double response) const;

  Problem* problem_ = nullptr;
  BlockCholesky matrix_;
  std::vector<int> sizes_;          // by body
  std::vector<double> inertia_;     // mass matrices
  std::vector<std::size_t> begin_;  // start of each body's mass matrix
  std::vector<Term> terms_;
  std::vector<double> impulses_;  // by row
  std::vector<double> velocity_;  // vectors as in the matrix
  std::vector<double> momentum_;  // that the impulses have added
  std::vector<double> step_;      // step of the velocity
  std::vector<double> step_momentum_;
  std::vector<double> found_;  // the velocity at the last minimum
  bool is_factorised_ = false;
};

}  // namespace cohort::physics
