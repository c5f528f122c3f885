// SPDX-License-Identifier: Apache-2.0
#include "server/physics/solvers/convex_rows.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace cohort::physics {
namespace {

// Shares of what the heaviest body yields. A smaller one needs fewer minima, a larger one fewer steps to each of them.
constexpr double share_of_pushes = 1e-6;     // contacts, limits of joints, loops and connections
constexpr double share_of_friction = 1e-2;   // friction and motors
constexpr double share_of_own_yield = 1e-1;  // the same, as a share of what the bodies of the row yield

double length_of(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace

void ConvexRows::gather(Problem& problem, const std::vector<std::vector<double>>& inertia) {
  problem_ = &problem;
  const std::vector<Row>& rows = problem.rows();
  impulses_.assign(rows.size(), 0.0);
  terms_.clear();

  double mass = 0.0;
  for (int body = 0; body < problem.body_count(); ++body)
    mass = std::max(mass, problem.equations(body).mechanism().moving_mass());
  yielding_to_force_ = 1.0 / mass;
  if (yielding_.size() < inertia.size()) yielding_.resize(inertia.size());
  for (int body = 0; body < problem.body_count(); ++body) {
    const Mechanism& mechanism = problem.equations(body).mechanism();
    std::vector<double>& yielding = yielding_[at(body)];
    yielding.resize(inertia[at(body)].size());
    for (std::size_t dof = 0; dof < yielding.size(); ++dof)
      yielding[dof] = mechanism.mass_beyond(static_cast<int>(dof)) / (inertia[at(body)][dof] * mass);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const bool is_disc = row.limits == Row::Limits::cone;
    if (row.limits == Row::Limits::coned || (is_disc ? row.cone_inverse : row.inverse) == 0.0) continue;
    ConvexTerm& term = terms_.emplace_back();
    term.row = i;
    if (is_disc) term.count = 2;
    term.softness = row.softness;
    term.lower = row.lower;
    term.upper = row.upper;
    for (std::size_t k = 0; k < term.count; ++k) impulses_[i + k] = term.impulse[k] = rows[i + k].impulse;
    set_compliance(term);
    assert(!(term.compliance + term.softness <= 0.0) && !(term.lower > term.upper));
  }
  for (ConvexTerm& term : terms_) guess_limit(term);
}

// A degree of freedom counts with the radius of gyration of what it moves: a wheel with its radius, an arm with its
// length.
void ConvexRows::set_compliance(ConvexTerm& term) {
  const Row& of = row(term);
  double yielding = 0.0;  // velocity that a unit impulse would give to the heaviest body
  if (of.is_of_force) {
    yielding = yielding_to_force_;
  } else {
    const double* jacobian = problem_->numbers() + of.numbers;
    for (const int body : {of.body_a, of.body_b}) {
      if (body < 0) continue;
      const std::vector<double>& its = yielding_[at(body)];
      for (std::size_t dof = 0; dof < its.size(); ++dof) yielding += jacobian[dof] * jacobian[dof] * its[dof];
      jacobian += 2 * problem_->equations(body).stride();
    }
  }
  const bool has_lower = !of.has_fixed_limits() || of.lower > -unlimited;
  const bool has_upper = !of.has_fixed_limits() || of.upper < unlimited;
  term.has_guess = has_lower && has_upper && !of.is_hold;
  if (!term.has_guess) {
    term.compliance = share_of_pushes * yielding;
    return;
  }
  const double own = 1.0 / (term.count == 2 ? of.cone_inverse : of.inverse);
  term.compliance = std::min(share_of_friction * yielding, share_of_own_yield * own);
}

void ConvexRows::guess_limit(ConvexTerm& term) {
  const Row& of = row(term);
  if (of.has_fixed_limits()) return;
  double load = load_of(of);
  if (load == 0.0)
    for (int j = of.load_begin; j < of.load_end; ++j) {
      const Row& other = problem_->rows()[at(j)];
      load += std::max(0.0, (other.target - problem_->velocity(other)) * other.inverse);
    }
  term.upper = limit_of_friction(of, load);
  term.lower = -term.upper;
}

// Returns the impulse of a row without regard to its limits.
inline double ConvexRows::wanted(const ConvexTerm& term, std::size_t i, double share) const {
  const double missing = row(term, i).target - term.velocity[i] - share * term.change[i];
  return (term.compliance * term.guess[i] + missing) / (term.compliance + term.softness);
}

void ConvexRows::evaluate(ConvexTerm& term, double share) const {
  const double stiffness = 1.0 / (term.compliance + term.softness);
  const double first = wanted(term, 0, share);
  if (term.count == 1) {
    term.impulse[0] = std::clamp(first, term.lower, term.upper);
    term.stiffness[0] = term.impulse[0] == first ? stiffness : 0.0;
    return;
  }
  const double second = wanted(term, 1, share);
  const double length = length_of(first, second);
  if (length <= term.upper) {
    term.impulse = {first, second};
    term.stiffness = {stiffness, stiffness, 0.0};
    return;
  }
  const double part = term.upper / length;
  const double x = first / length;
  const double y = second / length;
  term.impulse = {part * first, part * second};
  term.stiffness = {part * stiffness * y * y, part * stiffness * x * x, -part * stiffness * x * y};
}

void ConvexRows::extend(ConvexTerm& term) const {
  constexpr double nearly = 0.99;
  const auto is_at = [&](double limit) { return limit != 0.0 && term.impulse[0] / limit >= nearly; };
  if (term.count == 1 && (is_at(term.lower) || is_at(term.upper))) {
    term.impulse[0] = is_at(term.lower) ? term.lower : term.upper;
    term.stiffness = {};
    return;
  }
  const bool is_within =
      term.count == 1 ? term.impulse[0] != 0.0 : length_of(term.impulse[0], term.impulse[1]) < nearly * term.upper;
  if (!is_within) return evaluate(term, 0.0);
  const double stiffness = 1.0 / (term.compliance + term.softness);
  for (std::size_t i = 0; i < term.count; ++i) term.impulse[i] = wanted(term, i, 0.0);
  term.stiffness = {stiffness, term.count == 2 ? stiffness : 0.0, 0.0};
}

double ConvexRows::load_of(const Row& row) const {
  return load_on(row, [&](std::size_t i) { return impulses_[i]; });
}

void ConvexRows::update(double share) {
  for (ConvexTerm& term : terms_) {
    if (term.has_guess) term.guess = term.impulse;
    for (std::size_t i = 0; i < term.count; ++i) impulses_[term.row + i] = term.impulse[i];
  }
  for (ConvexTerm& term : terms_) {
    const Row& of = row(term);
    if (of.has_fixed_limits()) continue;
    term.upper += share * (limit_of_friction(of, load_of(of)) - term.upper);
    term.lower = -term.upper;
  }
}

void ConvexRows::apply() {
  for (Row& row : problem_->rows()) row.impulse = 0.0;
  for (const ConvexTerm& term : terms_)
    for (std::size_t i = 0; i < term.count; ++i) {
      Row& of = problem_->rows()[term.row + i];
      of.impulse = term.impulse[i];
      of.set_limits(term.lower, term.upper);
    }
}

}  // namespace cohort::physics
