// SPDX-License-Identifier: Apache-2.0
#include "server/physics/solvers/impacts.hpp"

#include <algorithm>
#include <cmath>

#include "server/physics/solvers/iterative_solver.hpp"

namespace cohort::physics {
namespace {

constexpr int most_rounds = 64;
constexpr std::uint32_t most_passes_a_round = 100;

double square(double x) { return x * x; }

// Returns the velocity after a rebound, without what forces add in this step. `velocity`: that before it; `gained`:
// what forces add to it in the step.
double rebound(const Row& row, double velocity, double gained) {
  const double half = 0.5 * gained;
  const double lost = -2.0 * gained * row.closing;  // square of the velocity that forces take on the way back
  const double at_touch = std::max(0.0, square(velocity + half) + lost);
  return std::sqrt(std::max(0.0, square(row.restitution) * at_touch - lost)) - half;
}

double gained_by_forces(double before, double after, double fall) { return std::clamp(after - before, -fall, fall); }

}  // namespace

void Impacts::solve(Problem& problem, double fall) {
  impulses_.clear();
  const auto hits = [&](const Row& row) {
    // Before the velocities, which cost time and which most rows do not need.
    return row.restitution > 0.0 && row.is_impact(problem.velocity_before(row), problem.velocity(row));
  };
  if (std::ranges::none_of(problem.rows(), hits)) return;

  gained_.clear();
  for (const Row& row : problem.rows())
    gained_.push_back(gained_by_forces(problem.velocity_before(row), problem.velocity(row), fall));

  free_.clear();
  const auto for_each_velocity = [&](auto&& visit) {
    for (int body = 0; body < problem.body_count(); ++body) {
      Equations& equations = problem.equations(body);
      for (int i = 0; i < equations.size(); ++i) visit(equations.velocity()[i], equations.body().velocities()[i]);
    }
  };
  for_each_velocity([&](double& now, double before) {
    free_.push_back(now - before);
    now = before;
  });
  rows_ = problem.rows();
  impulses_.assign(rows_.size(), 0.0);
  for (int round = 0; round < most_rounds && find_approaching(problem); ++round) solve_round(problem);

  problem.rows() = rows_;
  auto change = free_.begin();
  for_each_velocity([&](double& now, double) { now += *change++; });
}

// Prepares the rows for the next round. Returns false if no bodies approach each other any more.
bool Impacts::find_approaching(Problem& problem) {
  bool any = false;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& row = problem.rows()[i];
    row = rows_[i];
    row.impulse = 0.0;
    if (row.restitution == 0.0) continue;
    const double velocity = problem.velocity(row);
    if (row.is_impact(velocity, velocity + gained_[i])) {
      any = true;
      row.target = rebound(row, velocity, gained_[i]);
    } else {
      row.inverse = 0.0;
    }
  }
  return any;
}

void Impacts::solve_round(Problem& problem) {
  SequentialImpulses impulses(problem);
  for (std::uint32_t i = 0; i < most_passes_a_round; ++i)
    if (impulses.pass(i % 2 == 0) <= negligible_change) break;
  for (std::size_t i = 0; i < rows_.size(); ++i) impulses_[i] += problem.rows()[i].impulse;
}

void Impacts::add_impulses(Problem& problem) const {
  for (std::size_t i = 0; i < impulses_.size(); ++i) problem.rows()[i].impulse += impulses_[i];
}

void rebound_at_once(Problem& problem, double fall) {
  for (Row& row : problem.rows()) {
    if (row.restitution == 0.0) continue;
    const double before = problem.velocity_before(row);
    const double after = problem.velocity(row);
    if (!row.is_impact(before, after)) continue;
    const double gained = gained_by_forces(before, after, fall);
    row.target = std::max(row.target, rebound(row, before, gained) + gained);
  }
}

}  // namespace cohort::physics
