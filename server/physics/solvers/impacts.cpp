#include "server/physics/solvers/impacts.hpp"

#include <algorithm>

#include "server/physics/solvers/iterative_solver.hpp"

namespace cohort::physics {
namespace {

constexpr int most_rounds = 64;
constexpr std::uint32_t most_passes_a_round = 100;

bool approaches(const Row& row, double velocity) { return row.restitution > 0.0 && -velocity > row.least_approach; }

}  // namespace

void Impacts::solve(Problem& problem) {
  impulses_.clear();
  const auto hits = [&](const Row& row) { return approaches(row, problem.velocity_before(row)); };
  if (std::ranges::none_of(problem.rows(), hits)) return;

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
    if (approaches(row, velocity)) {
      any = true;
      row.target = -row.restitution * velocity;
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

void rebound_at_once(Problem& problem) {
  for (Row& row : problem.rows()) {
    const double velocity = row.restitution > 0.0 ? problem.velocity_before(row) : 0.0;
    if (approaches(row, velocity)) row.target = std::max(row.target, -row.restitution * velocity);
  }
}

}  // namespace cohort::physics
