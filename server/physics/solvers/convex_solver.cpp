#include "server/physics/solvers/convex_solver.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::physics {
namespace {

constexpr double most_factor_work = 4e6;  // multiplications in one factorisation
constexpr int most_dofs = 64;             // degrees of freedom of one body

// Usually a few steps find a minimum. Otherwise the rows yield more at first: by these shares of what the heaviest body
// yields, with which nearly any start is good enough.
constexpr int usual_steps = 5;
constexpr std::array softer{1.0, 0.1, 0.0};
constexpr int most_steps_a_minimum = 60;
constexpr double minimal = 1e-4;  // residual at a minimum

constexpr int most_minima = 8;
// Limits of friction move by this share of the way after the second minimum. With the whole way, limits that alternate
// would do so for long.
constexpr double share_of_limits = 0.6;
constexpr double settled = 1e-8;  // residual with new guesses and limits at which no other minimum is needed

// Line search: ends at this share of the first slope.
constexpr double flat_share = 0.1;
constexpr int most_trials = 30;

}  // namespace

bool ConvexSolver::solve(Problem& problem) {
  if (!prepare(problem)) return false;
  start();
  if (!minimise(Start::predicted, usual_steps))
    for (const double least : softer) {
      rows_.soften(least);
      minimise(least == softer.front() ? Start::present : Start::predicted, most_steps_a_minimum);
    }
  for (int minimum = 1; minimum < most_minima; ++minimum) {
    rows_.update(minimum == 1 ? 1.0 : share_of_limits);
    const bool is_same = evaluate();
    find_gradient();
    find_step();
    if (find_residual() <= settled) break;
    minimise(is_same ? Start::step : Start::present, most_steps_a_minimum);
  }
  apply();
  return true;
}

bool ConvexSolver::prepare(Problem& problem) {
  problem_ = &problem;
  sizes_.clear();
  double mass = 0.0;
  for (int body = 0; body < problem.body_count(); ++body) {
    const Equations& equations = problem.equations(body);
    if (!equations.is_symmetric() || equations.size() > most_dofs) return false;
    sizes_.push_back(equations.size());
    mass += equations.mechanism().moving_mass();
  }
  if (mass == 0.0) return false;
  matrix_.reset(sizes_);
  for (const Row& row : problem.rows())
    if (row.body_b >= 0) matrix_.couple(row.body_a, row.body_b);
  return matrix_.order(most_factor_work);
}

template <class Visit>
void ConvexSolver::for_each_body(const Row& row, Visit&& visit) const {
  const double* numbers = problem_->numbers() + row.numbers;
  visit(matrix_.offset(row.body_a), numbers, row.stride_a);
  if (row.body_b >= 0) visit(matrix_.offset(row.body_b), numbers + 2 * row.stride_a, row.stride_b);
}

double ConvexSolver::along(const Row& row, const std::vector<double>& velocities) const {
  double sum = 0.0;
  for_each_body(row, [&](std::size_t offset, const double* jacobian, std::ptrdiff_t stride) {
    sum += dot(jacobian, velocities.data() + offset, stride);
  });
  return sum;
}

void ConvexSolver::multiply_by_inertia(const std::vector<double>& velocities, std::vector<double>& momenta) const {
  momenta.assign(velocities.size(), 0.0);
  for (std::size_t body = 0; body < sizes_.size(); ++body) {
    const std::size_t offset = matrix_.offset(static_cast<int>(body));
    const auto stride = static_cast<std::ptrdiff_t>(matrix_.offset(static_cast<int>(body) + 1) - offset);
    for (int r = 0; r < sizes_[body]; ++r)
      momenta[offset + at(r)] = dot(inertia_.data() + begin_[body] + r * stride, velocities.data() + offset, stride);
  }
}

void ConvexSolver::take_inertia() {
  inertia_.clear();
  begin_.clear();
  if (diagonals_.size() < sizes_.size()) diagonals_.resize(sizes_.size());
  for (int body = 0; body < problem_->body_count(); ++body) {
    const Equations& equations = problem_->equations(body);
    begin_.push_back(inertia_.size());
    inertia_.resize(inertia_.size() + at(equations.size() * equations.stride()), 0.0);
    equations.add_inertia(inertia_.data() + begin_.back());
    std::vector<double>& diagonal = diagonals_[at(body)];
    diagonal.clear();
    for (int i = 0; i < equations.size(); ++i)
      diagonal.push_back(inertia_[begin_.back() + at(i * (equations.stride() + 1))]);
  }
}

// Starts from the velocities with the impulses of the last step.
void ConvexSolver::start() {
  is_factorised_ = false;
  take_inertia();
  rows_.gather(*problem_, diagonals_);
  without_impulses_.resize(matrix_.length());
  step_.assign(matrix_.length(), 0.0);
  for (int body = 0; body < problem_->body_count(); ++body) {
    const Equations& equations = problem_->equations(body);
    const std::size_t offset = matrix_.offset(body);
    std::copy_n(equations.velocity(), equations.stride(), without_impulses_.data() + offset);
    for (int i = 0; i < equations.size(); ++i)
      step_[offset + at(i)] = equations.velocity()[i] - equations.body().velocities()[i];
  }
  multiply_by_inertia(step_, step_momentum_);
  by_forces_ = dot(step_.data(), step_momentum_.data(), static_cast<std::ptrdiff_t>(step_.size()));

  velocity_ = without_impulses_;
  momentum_.assign(matrix_.length(), 0.0);
  for (ConvexTerm& term : rows_.terms()) {
    const Row& first = rows_.row(term);
    term.blocks[0] = matrix_.block(first.body_a, first.body_a);
    if (first.body_b >= 0) {
      term.blocks[1] = matrix_.block(first.body_b, first.body_b);
      term.blocks[2] = matrix_.block(first.body_a, first.body_b);
    }
    for (std::size_t i = 0; i < term.count; ++i) {
      if (term.impulse[i] == 0.0) continue;
      for_each_body(rows_.row(term, i), [&](std::size_t offset, const double* numbers, std::ptrdiff_t stride) {
        add_scaled(term.impulse[i], numbers, momentum_.data() + offset, stride);
        add_scaled(term.impulse[i], numbers + stride, velocity_.data() + offset, stride);
      });
    }
  }
  for (ConvexTerm& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) term.velocity[i] = along(rows_.row(term, i), velocity_);
}

// Makes steps to the minimum; afterwards the impulses belong to the velocities. Returns false if it was not found.
bool ConvexSolver::minimise(Start start, int most_steps) {
  bool is_predicted = start == Start::predicted;
  bool is_same = false;
  if (is_predicted)
    for (ConvexTerm& term : rows_.terms()) rows_.extend(term);
  else if (start == Start::present)
    is_same = evaluate();
  for (int i = 0; i < most_steps; ++i) {
    if (i > 0 || start != Start::step) {
      find_gradient();
      if (!is_factorised_ || !(is_same || is_near())) factorise();
      find_step();
    }
    const bool is_minimum = !is_predicted && find_residual() <= minimal;
    double share = 1.0;
    if (!is_predicted && !is_minimum) share = find_share();
    add_step(share);
    is_same = evaluate();
    // The function is quadratic as long as the stiffness of all rows is the same.
    if (is_minimum || (is_same && share == 1.0)) return true;
    is_predicted = false;
  }
  return false;
}

void ConvexSolver::add_step(double share) {
  const auto length = static_cast<std::ptrdiff_t>(velocity_.size());
  add_scaled(share, step_.data(), velocity_.data(), length);
  add_scaled(share, step_momentum_.data(), momentum_.data(), length);
  for (ConvexTerm& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) term.velocity[i] += share * term.change[i];
}

// Computes all impulses. Returns whether the present factors belong to their derivatives.
bool ConvexSolver::evaluate() {
  bool is_same = true;
  for (ConvexTerm& term : rows_.terms()) {
    rows_.evaluate(term, 0.0);
    is_same = is_same && term.stiffness == term.factorised;
  }
  return is_same;
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

void ConvexSolver::find_gradient() {
  gradient_ = momentum_;
  for (const ConvexTerm& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) {
      if (term.impulse[i] == 0.0) continue;
      for_each_body(rows_.row(term, i), [&](std::size_t offset, const double* jacobian, std::ptrdiff_t stride) {
        add_scaled(-term.impulse[i], jacobian, gradient_.data() + offset, stride);
      });
    }
}

void ConvexSolver::factorise() {
  matrix_.clear();
  for (int body = 0; body < problem_->body_count(); ++body) {
    double* const into = matrix_.values(matrix_.block(body, body));
    std::copy_n(inertia_.data() + begin_[at(body)], sizes_[at(body)] * problem_->equations(body).stride(), into);
  }
  for (ConvexTerm& term : rows_.terms()) {
    add_outer_products(term);
    term.factorised = term.stiffness;
  }
  matrix_.factorise();
  is_factorised_ = true;
}

void ConvexSolver::add_outer_products(const ConvexTerm& term) {
  const auto add = [](double factor, const double* rows, int count, const double* columns, std::ptrdiff_t stride,
                      double* into) {
    for (int r = 0; r < count; ++r)
      if (rows[r] != 0.0) add_scaled(factor * rows[r], columns, into + r * stride, stride);
  };
  const auto add_lower = [](double factor, const double* rows, int count, const double* columns, std::ptrdiff_t stride,
                            double* into) {
    for (int r = 0; r < count; ++r)
      if (rows[r] != 0.0) add_scaled(factor * rows[r], columns, into + r * stride, (r / lanes + 1) * lanes);
  };
  const auto add_rows = [&](double stiffness, const Row& one, const Row& two) {
    if (stiffness == 0.0) return;
    const double* of_one = problem_->numbers() + one.numbers;
    const double* of_two = problem_->numbers() + two.numbers;
    add_lower(stiffness, of_one, sizes_[at(one.body_a)], of_two, one.stride_a, matrix_.values(term.blocks[0]));
    if (one.body_b < 0) return;
    const double* b_of_one = of_one + 2 * one.stride_a;
    const double* b_of_two = of_two + 2 * one.stride_a;
    add_lower(stiffness, b_of_one, sizes_[at(one.body_b)], b_of_two, one.stride_b, matrix_.values(term.blocks[1]));
    const bool is_a_later = term.blocks[2].row == one.body_a;
    add(stiffness, is_a_later ? of_one : b_of_one, sizes_[at(term.blocks[2].row)], is_a_later ? b_of_two : of_two,
        is_a_later ? one.stride_b : one.stride_a, matrix_.values(term.blocks[2]));
  };
  const Row& first = rows_.row(term);
  add_rows(term.stiffness[0], first, first);
  if (term.count == 1) return;
  const Row& second = rows_.row(term, 1);
  add_rows(term.stiffness[1], second, second);
  add_rows(term.stiffness[2], first, second);
  add_rows(term.stiffness[2], second, first);
}

void ConvexSolver::find_step() {
  for (std::size_t i = 0; i < step_.size(); ++i) step_[i] = -gradient_[i];
  matrix_.solve(step_.data());
  multiply_by_inertia(step_, step_momentum_);
  for (ConvexTerm& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) term.change[i] = along(rows_.row(term, i), step_);
}

double ConvexSolver::find_residual() const {
  double square = 0.0;
  double by_impulses = 0.0;
  for (std::size_t i = 0; i < step_.size(); ++i) {
    square -= step_[i] * gradient_[i];
    by_impulses += momentum_[i] * (velocity_[i] - without_impulses_[i]);
  }
  const double all = by_forces_ + by_impulses;
  return all > 0.0 ? std::sqrt(std::max(0.0, square) / all) : 0.0;
}

// Computes the derivative of the function along the step at a share of it.
double ConvexSolver::slope(double share, double* curvature) {
  const auto length = static_cast<std::ptrdiff_t>(step_.size());
  *curvature = dot(step_.data(), step_momentum_.data(), length);
  double sum = dot(step_.data(), momentum_.data(), length) + share * *curvature;
  for (ConvexTerm& term : rows_.terms()) {
    rows_.evaluate(term, share);
    const auto& [first, second] = term.change;
    sum -= term.impulse[0] * first;
    *curvature += term.stiffness[0] * first * first;
    if (term.count == 1) continue;
    sum -= term.impulse[1] * second;
    *curvature += term.stiffness[1] * second * second + 2.0 * term.stiffness[2] * first * second;
  }
  return sum;
}

// Finds the share of the step at which the function is least.
double ConvexSolver::find_share() {
  double curvature = 0.0;
  const double enough =
      flat_share * std::abs(dot(step_.data(), gradient_.data(), static_cast<std::ptrdiff_t>(step_.size())));
  double low = 0.0;
  double high = 1.0;
  double share = 1.0;
  for (int i = 0; i < most_trials; ++i) {
    const double there = slope(share, &curvature);
    if (std::abs(there) <= enough || (share == 1.0 && there <= 0.0)) break;
    (there < 0.0 ? low : high) = share;
    share -= there / curvature;
    if (!(share > low && share < high)) share = 0.5 * (low + high);
  }
  return share;
}

void ConvexSolver::apply() {
  rows_.apply();
  for (int body = 0; body < problem_->body_count(); ++body)
    std::copy_n(velocity_.data() + matrix_.offset(body), problem_->equations(body).stride(),
                problem_->equations(body).velocity());
}

}  // namespace cohort::physics
