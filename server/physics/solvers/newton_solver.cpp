#include "server/physics/solvers/newton_solver.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::physics {
namespace {

constexpr double most_elimination_work = 4e6;  // multiplications in one factorisation
constexpr int most_dofs_of_body = 64;
constexpr int most_steps = 30;  // steps of Newton's method, in all minima together
constexpr int most_shares = 20;
constexpr double flat = 0.1;  // share of the first slope at which a line search ends

// A limit of friction may still change by this multiple of the negligible error, as it would change the velocity of a
// free body.
constexpr double limits_tolerance = 100.0;

}  // namespace

bool NewtonSolver::solve(Problem& problem, double negligible, int most_minima) {
  if (!is_small(problem)) return false;
  problem_ = &problem;
  rows_.gather(problem);
  start();
  if (!rows_.are_settled(0.1 * negligible) && !(prepare() && follow(negligible, most_minima))) return false;
  apply();
  return true;
}

bool NewtonSolver::is_small(const Problem& problem) {
  sizes_.clear();
  for (int body = 0; body < problem.body_count(); ++body) sizes_.push_back(problem.equations(body).size());
  return std::ranges::all_of(sizes_, [](int size) { return size <= most_dofs_of_body; });
}

// Starts from the impulses of the last step.
void NewtonSolver::start() {
  matrix_.reset(sizes_);
  velocity_.resize(matrix_.length());
  momentum_.assign(matrix_.length(), 0.0);
  for (int body = 0; body < problem_->body_count(); ++body)
    std::copy_n(problem_->equations(body).velocity(), problem_->equations(body).stride(),
                velocity_.data() + matrix_.offset(body));
  for (std::size_t i = 0; i < rows_.impulses().size(); ++i) {
    if (rows_.impulses()[i] == 0.0) continue;
    const Row& row = problem_->rows()[i];
    const double* numbers = problem_->numbers() + row.numbers;
    for (const int body : {row.body_a, row.body_b}) {
      if (body < 0) continue;
      const std::ptrdiff_t stride = problem_->equations(body).stride();
      add_scaled(rows_.impulses()[i], numbers, momentum_.data() + matrix_.offset(body), stride);
      add_scaled(rows_.impulses()[i], numbers + stride, velocity_.data() + matrix_.offset(body), stride);
      numbers += 2 * stride;
    }
  }
  for (YieldingRow& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) term.velocity[i] = along(row(term, i), velocity_);
  rows_.guess_loads([this](const Row& row) { return along(row, velocity_); });
}

double NewtonSolver::along(const Row& row, const std::vector<double>& velocities) const {
  const double* jacobian = problem_->numbers() + row.numbers;
  double sum = dot(jacobian, velocities.data() + matrix_.offset(row.body_a), row.stride_a);
  if (row.body_b >= 0)
    sum += dot(jacobian + 2 * row.stride_a, velocities.data() + matrix_.offset(row.body_b), row.stride_b);
  return sum;
}

// Returns false if a factorisation would cost too much.
bool NewtonSolver::prepare() {
  for (const Row& row : problem_->rows())
    if (row.body_b >= 0) matrix_.couple(row.body_a, row.body_b);
  if (!matrix_.order(most_elimination_work)) return false;
  is_factorised_ = false;
  for (YieldingRow& term : rows_.terms()) {
    const Row& first = row(term);
    term.blocks[0] = matrix_.block(first.body_a, first.body_a);
    if (first.body_b < 0) continue;
    term.blocks[1] = matrix_.block(first.body_b, first.body_b);
    term.blocks[2] = matrix_.block(first.body_a, first.body_b);
  }
  inertia_.clear();
  begin_.clear();
  for (int body = 0; body < problem_->body_count(); ++body) {
    const Equations& equations = problem_->equations(body);
    begin_.push_back(inertia_.size());
    inertia_.resize(inertia_.size() + at(equations.size() * equations.stride()), 0.0);
    equations.add_inertia(inertia_.data() + begin_.back());
  }
  return true;
}

// Finds minima until the rows do not yield any more. Returns false if it does not even find the first.
bool NewtonSolver::follow(double negligible, int most_minima) {
  int steps_left = most_steps;
  for (int minimum = 0; minimum < most_minima; ++minimum) {
    double moved = 0.0;
    if (!minimise(negligible, steps_left, moved)) {
      velocity_ = found_;
      return minimum > 0;
    }
    found_ = velocity_;
    const double yielded = rows_.update_guesses();
    const double limits = rows_.update_limits();
    if (minimum > 0 && moved <= negligible) return true;
    if (yielded <= negligible && limits <= limits_tolerance * negligible) return true;
  }
  return true;
}

// Returns false if no minimum was found in the steps that are left.
bool NewtonSolver::minimise(double negligible, int& steps_left, double& moved) {
  bool is_whole = false;
  for (; steps_left > 0; --steps_left) {
    const bool is_same = evaluate();
    if (is_whole && is_same) return true;
    if (!is_factorised_ || !is_same) factorise();
    const double greatest = find_step();
    moved = std::max(moved, greatest);
    const bool is_last = greatest <= negligible;
    const double share = is_last ? 1.0 : find_share();
    add_step(share);
    if (is_last) {
      evaluate();
      return true;
    }
    is_whole = share == 1.0;
  }
  return false;
}

void NewtonSolver::add_step(double share) {
  add_scaled(share, step_.data(), velocity_.data(), static_cast<std::ptrdiff_t>(velocity_.size()));
  add_scaled(share, step_momentum_.data(), momentum_.data(), static_cast<std::ptrdiff_t>(momentum_.size()));
  for (YieldingRow& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) term.velocity[i] += share * term.change[i];
}

// Computes all impulses. Returns whether the present factors belong to their derivatives.
bool NewtonSolver::evaluate() {
  bool is_same = true;
  for (YieldingRow& term : rows_.terms()) {
    rows_.evaluate(term, 0.0);
    is_same = is_same && term.stiffness == term.factorised;
  }
  return is_same;
}

void NewtonSolver::factorise() {
  matrix_.clear();
  for (int body = 0; body < problem_->body_count(); ++body) {
    double* const into = matrix_.values(matrix_.block(body, body));
    const std::ptrdiff_t stride = problem_->equations(body).stride();
    std::copy_n(inertia_.data() + begin_[at(body)], sizes_[at(body)] * stride, into);
  }
  for (YieldingRow& term : rows_.terms()) {
    add_outer_products(term);
    term.factorised = term.stiffness;
  }
  matrix_.factorise();
  is_factorised_ = true;
}

void NewtonSolver::add_outer_products(const YieldingRow& term) {
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
  add_rows(term.stiffness[0], row(term), row(term));
  if (term.count == 1) return;
  add_rows(term.stiffness[1], row(term, 1), row(term, 1));
  add_rows(term.stiffness[2], row(term), row(term, 1));
  add_rows(term.stiffness[2], row(term, 1), row(term));
}

double NewtonSolver::find_step() {
  step_.resize(momentum_.size());
  for (std::size_t i = 0; i < step_.size(); ++i) step_[i] = -momentum_[i];
  for (const YieldingRow& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) {
      const Row& of = row(term, i);
      const double* jacobian = problem_->numbers() + of.numbers;
      add_scaled(term.impulse[i], jacobian, step_.data() + matrix_.offset(of.body_a), of.stride_a);
      if (of.body_b >= 0)
        add_scaled(term.impulse[i], jacobian + 2 * of.stride_a, step_.data() + matrix_.offset(of.body_b), of.stride_b);
    }
  matrix_.solve(step_.data());
  step_momentum_.assign(step_.size(), 0.0);
  for (int body = 0; body < problem_->body_count(); ++body) {
    const std::ptrdiff_t stride = problem_->equations(body).stride();
    for (int r = 0; r < sizes_[at(body)]; ++r)
      step_momentum_[matrix_.offset(body) + at(r)] =
          dot(inertia_.data() + begin_[at(body)] + r * stride, step_.data() + matrix_.offset(body), stride);
  }
  double greatest = 0.0;
  for (YieldingRow& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) {
      term.change[i] = along(row(term, i), step_);
      greatest = std::max(greatest, std::abs(term.change[i]));
    }
  return greatest;
}

// Computes the derivative of the function along the step at a share of it.
double NewtonSolver::slope(double share, double* curvature) {
  const auto length = static_cast<std::ptrdiff_t>(step_.size());
  *curvature = dot(step_.data(), step_momentum_.data(), length);
  double sum = dot(step_.data(), momentum_.data(), length) + share * *curvature;
  for (YieldingRow& term : rows_.terms()) {
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
double NewtonSolver::find_share() {
  double curvature = 0.0;
  const double at_start = slope(0.0, &curvature);
  const double enough = flat * std::abs(at_start);
  double low = 0.0;
  double high = 1.0;
  double share = 1.0;
  for (int i = 0; i < most_shares; ++i) {
    const double there = slope(share, &curvature);
    if (std::abs(there) <= enough || (share == 1.0 && there <= 0.0)) break;
    (there < 0.0 ? low : high) = share;
    share -= there / curvature;
    if (!(share > low && share < high)) share = 0.5 * (low + high);
  }
  return share;
}

void NewtonSolver::apply() {
  rows_.apply();
  for (int body = 0; body < problem_->body_count(); ++body)
    std::copy_n(velocity_.data() + matrix_.offset(body), problem_->equations(body).stride(),
                problem_->equations(body).velocity());
}

}  // namespace cohort::physics
