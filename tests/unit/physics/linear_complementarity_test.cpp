// SPDX-License-Identifier: Apache-2.0
#include "server/physics/solvers/linear_complementarity.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "server/core/infinity.hpp"
#include "server/core/random.hpp"

namespace cohort::test {
namespace {

using physics::LinearComplementarity;

struct Problem {
  std::vector<double> matrix, b, lower, upper;
};

// Returns a problem with rows of contacts, of friction, of motors without limits, and some that cannot move at all.
Problem random_problem(std::uint64_t number, std::size_t size) {
  const RandomStream random(7, "linear_complementarity", "problems");
  std::uint32_t drawn = 0;
  const auto draw = [&] { return 2.0 * random.uniform(number, drawn++) - 1.0; };
  Problem problem;
  const std::size_t rank = std::max<std::size_t>(1, 2 * size / 3);  // as with redundant rows
  std::vector<double> factors(size * rank);
  for (double& each : factors) each = draw();
  problem.matrix.assign(size * size, 0.0);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j)
      for (std::size_t k = 0; k < rank; ++k)
        problem.matrix[i * size + j] += factors[i * rank + k] * factors[j * rank + k];
    problem.matrix[i * size + i] *= 1.0 + 1e-6;
    problem.b.push_back(draw());
    const std::size_t kind = i % 4;
    problem.lower.push_back(kind == 0 || kind == 3 ? 0.0 : kind == 1 ? -0.1 * std::abs(draw()) : -infinity);
    problem.upper.push_back(kind == 0 || kind == 2 ? infinity : kind == 1 ? -problem.lower.back() : 0.0);
  }
  return problem;
}

std::vector<double> solution_of(LinearComplementarity& solver, const Problem& problem, bool& solved) {
  std::vector<double> x(problem.b.size());
  solved = solver.solve(problem.matrix, problem.b, problem.lower, problem.upper, x);
  return x;
}

TEST(LinearComplementarity, EveryRowSatisfiesItsCondition) {
  LinearComplementarity solver;
  std::size_t at_limits = 0;
  for (std::uint64_t number = 0; number < 300; ++number) {
    const std::size_t size = 1 + number % 60;
    SCOPED_TRACE("problem " + std::to_string(number) + " of " + std::to_string(size) + " rows");
    const Problem problem = random_problem(number, size);
    bool solved = false;
    const std::vector<double> x = solution_of(solver, problem, solved);
    ASSERT_TRUE(solved);
    for (std::size_t i = 0; i < size; ++i) {
      double excess = -problem.b[i];
      for (std::size_t j = 0; j < size; ++j) excess += problem.matrix[i * size + j] * x[j];
      constexpr double tolerance = 1e-6;
      ASSERT_GE(x[i], problem.lower[i]);
      ASSERT_LE(x[i], problem.upper[i]);
      if (x[i] > problem.lower[i]) {
        ASSERT_LT(excess, tolerance) << "row " << i << " should be less";
      }
      if (x[i] < problem.upper[i]) {
        ASSERT_GT(excess, -tolerance) << "row " << i << " should be more";
      }
      at_limits += x[i] == problem.lower[i] || x[i] == problem.upper[i] ? 1 : 0;
    }
  }
  EXPECT_GT(at_limits, 1000u);
}

TEST(LinearComplementarity, ReportsThatAMatrixIsNotDefinite) {
  LinearComplementarity solver;
  Problem problem = random_problem(3, 8);
  for (double& each : problem.matrix) each = -each;
  bool solved = true;
  solution_of(solver, problem, solved);
  EXPECT_FALSE(solved);
}

// A library's solver kept its failure flag in one variable of the process.
TEST(LinearComplementarity, AFailureDoesNotAffectOtherSolvers) {
  std::vector<Problem> problems;
  std::vector<std::vector<double>> alone;
  LinearComplementarity solver;
  bool solved = false;
  for (std::uint64_t number = 0; number < 40; ++number) {
    problems.push_back(random_problem(number, 24));
    alone.push_back(solution_of(solver, problems.back(), solved));
    ASSERT_TRUE(solved);
  }
  std::atomic<bool> goes_on = true;
  std::atomic<int> failures = 0;
  std::thread other([&] {
    LinearComplementarity its_own;
    Problem flawed = random_problem(1, 24);
    for (double& each : flawed.matrix) each = -each;
    bool any = true;
    while (goes_on) {
      solution_of(its_own, flawed, any);
      failures += any ? 0 : 1;
    }
  });
  while (failures == 0) std::this_thread::yield();
  for (int round = 0; round < 20; ++round) {
    for (std::size_t i = 0; i < problems.size(); ++i) {
      EXPECT_EQ(solution_of(solver, problems[i], solved), alone[i]);
      EXPECT_TRUE(solved);
    }
  }
  goes_on = false;
  other.join();
}

}  // namespace
}  // namespace cohort::test
