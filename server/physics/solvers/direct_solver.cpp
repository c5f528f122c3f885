// SPDX-License-Identifier: Apache-2.0
#include "server/physics/solvers/direct_solver.hpp"

#include <algorithm>
#include <cmath>

#include "server/physics/solvers/friction_limits.hpp"
#include "server/physics/solvers/linear_complementarity.hpp"

namespace cohort::physics {
namespace {

class DirectSolver {
 public:
  explicit DirectSolver(Problem& problem) : problem_(problem), count_(problem.row_count()), size_(index(count_)) {}

  bool run() {
    gather();
    set_limits(1.0);
    for (int solution = 0; solution < most_solutions; ++solution) {
      if (!complementarity_.solve(gains_, wanted_, lower_, upper_, impulses_)) return false;
      if (set_limits(solution < undamped_solutions ? 1.0 : share_of_limits)) break;
    }
    apply();
    return true;
  }

 private:
  // Number of solutions, each with friction limits from the normal impulses of the previous one. The limits move the
  // whole way at first, since most settle within a few solutions.
  static constexpr int undamped_solutions = 8;
  static constexpr int most_solutions = 64;
  static constexpr double limit_tolerance = 1e-9;  // [N s or N m s]
  // Compliance of each row as a share of its own response; without it, redundant rows have no solution.
  static constexpr double give = 1e-6;

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  const Row& row_at(int i) const { return problem_.rows()[index(i)]; }

  // Returns the velocity of row i by a unit impulse in row j: the sum over the bodies on which both act.
  double gain(const Row& i, const Row& j) const {
    const double* jacobian_a = problem_.numbers() + i.numbers;
    const double* jacobian_b = jacobian_a + 2 * i.stride_a;
    const double* response_a = problem_.numbers() + j.numbers + j.stride_a;
    const double* response_b = response_a + j.stride_a + j.stride_b;
    double sum = 0.0;
    if (i.velocity_a == j.velocity_a) sum += dot(jacobian_a, response_a, i.stride_a);
    if (j.velocity_b != nullptr && i.velocity_a == j.velocity_b) sum += dot(jacobian_a, response_b, i.stride_a);
    if (i.velocity_b == nullptr) return sum;
    if (i.velocity_b == j.velocity_a) sum += dot(jacobian_b, response_a, i.stride_b);
    if (i.velocity_b == j.velocity_b) sum += dot(jacobian_b, response_b, i.stride_b);
    return sum;
  }

  void gather() {
    gains_.resize(size_ * size_);
    wanted_.resize(size_);
    impulses_.resize(size_);
    lower_.assign(size_, 0.0);
    upper_.assign(size_, 0.0);
    for (int i = 0; i < count_; ++i) {
      const Row& row = row_at(i);
      wanted_[index(i)] = row.target - problem_.velocity(row);
      impulses_[index(i)] = row.impulse;
      for (int j = 0; j <= i; ++j)
        gains_[index(i) * size_ + index(j)] = gains_[index(j) * size_ + index(i)] = gain(row, row_at(j));
      double& own = gains_[index(i) * size_ + index(i)];
      own += own * give + row.softness;
    }
  }

  // Moves the limits by this share towards those that follow from the present impulses. Returns false if a limit moved.
  bool set_limits(double share) {
    bool hold = true;
    for (int i = 0; i < count_; ++i) {
      const Row& row = row_at(i);
      double& lower = lower_[index(i)];
      double& upper = upper_[index(i)];
      if (row.inverse == 0.0) {
        lower = upper = 0.0;
      } else if (row.has_fixed_limits()) {
        lower = row.lower;
        upper = row.upper;
      } else {
        const double limit = limit_of_friction(row, load_on(row, [&](std::size_t k) { return impulses_[k]; }));
        if (std::abs(limit - upper) > limit_tolerance) hold = false;
        upper += share * (limit - upper);
        lower = -upper;
      }
    }
    return hold;
  }

  void apply() {
    for (int i = 0; i < count_; ++i) {
      Row& row = problem_.rows()[index(i)];
      row.impulse = impulses_[index(i)];
      row.set_limits(lower_[index(i)], upper_[index(i)]);
      const double* response = problem_.numbers() + row.numbers + row.stride_a;
      add_scaled(row.impulse, response, row.velocity_a, row.stride_a);
      if (row.velocity_b != nullptr)
        add_scaled(row.impulse, response + row.stride_a + row.stride_b, row.velocity_b, row.stride_b);
    }
  }

  Problem& problem_;
  int count_;
  std::size_t size_;
  std::vector<double> gains_;
  std::vector<double> wanted_;
  std::vector<double> impulses_;
  std::vector<double> lower_;
  std::vector<double> upper_;
  LinearComplementarity complementarity_;
};

}  // namespace

bool solve_directly(Problem& problem) {
  if (problem.row_count() == 0) return true;
  return DirectSolver(problem).run();
}

}  // namespace cohort::physics
