// SPDX-License-Identifier: Apache-2.0
#include "server/physics/solvers/convex_solver.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::physics {
namespace {

constexpr int most_steps_a_minimum = 60;
// The last step to a minimum, as a share of what forces and impulses change.
constexpr double minimal = 1e-4;

constexpr int most_minima = 32;
constexpr double settled = 1e-9;  // residual with new guesses and limits at which no other minimum is needed

}  // namespace

std::optional<Convergence::Outcome> ConvexSolver::solve(Problem& problem, std::uint32_t most_steps) {
  double mass = 0.0;
  for (int body = 0; body < problem.body_count(); ++body) {
    if (!problem.equations(body).is_symmetric()) return std::nullopt;
    mass += problem.equations(body).mechanism().moving_mass();
  }
  if (mass == 0.0) return std::nullopt;
  take_bodies(problem);
  if (!take_inertia()) return std::nullopt;
  outcome_ = {};
  most_steps_ = most_steps;
  start();
  minimise(From::impulses);
  outcome_.error = settle();
  if (outcome_.steps > most_steps) return std::nullopt;
  apply();
  return outcome_;
}

// Finds one minimum after the other, each with guesses and limits from the last, until they satisfy the rows. Returns
// the residual.
double ConvexSolver::settle() {
  double residual = 0.0;
  for (int minimum = 1; minimum < most_minima && outcome_.steps <= most_steps_; ++minimum) {
    rows_.update(minimum == 1 ? 1.0 : share_of_limits);
    const bool is_same = evaluate();
    find_step();
    residual = share_of_change(step_momentum_);
    if (residual <= settled) {
      add_step(1.0);
      evaluate();
      break;
    }
    minimise(is_same ? From::step : From::velocities);
  }
  return residual;
}

void ConvexSolver::start() {
  if (diagonals_.size() < sizes_.size()) diagonals_.resize(sizes_.size());
  without_impulses_.resize(matrix_.length());
  std::vector<double>& by_forces = step_;
  by_forces.assign(matrix_.length(), 0.0);
  for (int body = 0; body < problem_->body_count(); ++body) {
    const Equations& equations = problem_->equations(body);
    const std::size_t offset = matrix_.offset(body);
    std::copy_n(equations.velocity(), equations.stride(), without_impulses_.data() + offset);
    std::vector<double>& diagonal = diagonals_[at(body)];
    diagonal.clear();
    for (int i = 0; i < equations.size(); ++i) {
      diagonal.push_back(inertia_[begin_[at(body)] + at(i * (equations.stride() + 1))]);
      by_forces[offset + at(i)] = equations.velocity()[i] - equations.body().velocities()[i];
    }
  }
  multiply_by_inertia(by_forces, step_momentum_);
  by_forces_ = dot(by_forces.data(), step_momentum_.data(), length());
  rows_.gather(*problem_, diagonals_);
  start_with_impulses();
}

// Makes steps to the minimum; afterwards the impulses belong to the velocities.
void ConvexSolver::minimise(From from) {
  ++outcome_.minima;
  bool is_predicted = from == From::impulses;
  bool is_same = false;
  if (is_predicted)
    for (ConvexTerm& term : rows_.terms()) rows_.extend(term);
  else if (from == From::velocities)
    is_same = evaluate();
  for (int i = 0; i < most_steps_a_minimum && outcome_.steps <= most_steps_; ++i) {
    if (i > 0 || from != From::step) {
      if (!is_factorised_ || !(is_same || is_near())) {
        factorise();
        ++outcome_.factorisations;
      }
      find_step();
    }
    ++outcome_.steps;
    const bool is_minimum = !is_predicted && share_of_change(missing_) <= minimal;
    double share = 1.0;
    if (!is_predicted && !is_minimum) share = find_share(-dot(step_.data(), missing_.data(), length()));
    add_step(share);
    is_same = evaluate();
    // The function is quadratic as long as the stiffness of all rows is the same.
    if ((is_same && share == 1.0) || (is_minimum && is_near())) return;
    is_predicted = false;
  }
}

// Returns whether the present factors are good enough for a step.
bool ConvexSolver::is_near() const {
  constexpr double near = 0.2;
  for (const ConvexTerm& term : rows_.terms()) {
    const double most = near * (term.factorised[0] + term.factorised[1]);
    for (std::size_t i = 0; i < term.stiffness.size(); ++i)
      if (std::abs(term.stiffness[i] - term.factorised[i]) > most) return false;
  }
  return true;
}

// Returns the length of the step as a share of what forces and impulses change. It is measured by the matrix that gives
// the step this momentum: the mass matrix for `step_momentum_`, the factorised one for `missing_`.
double ConvexSolver::share_of_change(const std::vector<double>& momentum) const {
  double square = 0.0;
  double by_impulses = 0.0;
  for (std::size_t i = 0; i < step_.size(); ++i) {
    square += step_[i] * momentum[i];
    by_impulses += momentum_[i] * (velocity_[i] - without_impulses_[i]);
  }
  const double all = by_forces_ + by_impulses;
  return all > 0.0 ? std::sqrt(std::max(0.0, square) / all) : 0.0;
}

}  // namespace cohort::physics
