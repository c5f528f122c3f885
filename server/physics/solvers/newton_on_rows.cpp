// SPDX-License-Identifier: Apache-2.0
#include "server/physics/solvers/newton_on_rows.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::physics {
namespace {

constexpr double most_elimination_work = 4e6;  // multiplications in one factorisation
constexpr int most_shares = 20;
constexpr double flat = 0.1;  // share of the first slope at which a line search ends

}  // namespace

void NewtonOnRows::take_bodies(Problem& problem) {
  problem_ = &problem;
  is_factorised_ = false;
  sizes_.clear();
  for (int body = 0; body < problem.body_count(); ++body) sizes_.push_back(problem.equations(body).size());
  matrix_.reset(sizes_);
}

bool NewtonOnRows::take_inertia() {
  for (const Row& row : problem_->rows())
    if (row.body_b >= 0) matrix_.couple(row.body_a, row.body_b);
  if (!matrix_.order(most_elimination_work)) return false;
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

void NewtonOnRows::start_with_impulses() {
  velocity_.resize(matrix_.length());
  momentum_.assign(matrix_.length(), 0.0);
  for (int body = 0; body < problem_->body_count(); ++body)
    std::copy_n(problem_->equations(body).velocity(), problem_->equations(body).stride(),
                velocity_.data() + matrix_.offset(body));
  for (const ConvexTerm& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) {
      if (term.impulse[i] == 0.0) continue;
      for_each_body(rows_.row(term, i), [&](std::size_t offset, const double* numbers, std::ptrdiff_t stride) {
        add_scaled(term.impulse[i], numbers, momentum_.data() + offset, stride);
        add_scaled(term.impulse[i], numbers + stride, velocity_.data() + offset, stride);
      });
    }
  for (ConvexTerm& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) term.velocity[i] = along(rows_.row(term, i), velocity_);
}

bool NewtonOnRows::evaluate() {
  bool is_same = true;
  for (ConvexTerm& term : rows_.terms()) {
    rows_.evaluate(term, 0.0);
    is_same = is_same && term.stiffness == term.factorised;
  }
  return is_same && is_factorised_;
}

void NewtonOnRows::factorise() {
  matrix_.clear();
  for (int body = 0; body < problem_->body_count(); ++body) {
    double* const into = matrix_.values(matrix_.block(body, body));
    std::copy_n(inertia_.data() + begin_[at(body)], sizes_[at(body)] * problem_->equations(body).stride(), into);
  }
  for (ConvexTerm& term : rows_.terms()) {
    if (!is_factorised_) {
      const Row& first = rows_.row(term);
      term.blocks[0] = matrix_.block(first.body_a, first.body_a);
      if (first.body_b >= 0) {
        term.blocks[1] = matrix_.block(first.body_b, first.body_b);
        term.blocks[2] = matrix_.block(first.body_a, first.body_b);
      }
    }
    add_outer_products(term);
    term.factorised = term.stiffness;
  }
  matrix_.factorise();
  is_factorised_ = true;
}

void NewtonOnRows::add_outer_products(const ConvexTerm& term) {
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

void NewtonOnRows::find_step() {
  missing_.resize(momentum_.size());
  for (std::size_t i = 0; i < missing_.size(); ++i) missing_[i] = -momentum_[i];
  for (const ConvexTerm& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i)
      for_each_body(rows_.row(term, i), [&](std::size_t offset, const double* jacobian, std::ptrdiff_t stride) {
        add_scaled(term.impulse[i], jacobian, missing_.data() + offset, stride);
      });
  step_ = missing_;
  matrix_.solve(step_.data());
  multiply_by_inertia(step_, step_momentum_);
  for (ConvexTerm& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) term.change[i] = along(rows_.row(term, i), step_);
}

double NewtonOnRows::slope(double share, double* curvature) {
  *curvature = dot(step_.data(), step_momentum_.data(), length());
  double sum = dot(step_.data(), momentum_.data(), length()) + share * *curvature;
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

double NewtonOnRows::find_share(double first_slope) {
  double curvature = 0.0;
  const double enough = flat * std::abs(first_slope);
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

void NewtonOnRows::add_step(double share) {
  add_scaled(share, step_.data(), velocity_.data(), length());
  add_scaled(share, step_momentum_.data(), momentum_.data(), length());
  for (ConvexTerm& term : rows_.terms())
    for (std::size_t i = 0; i < term.count; ++i) term.velocity[i] += share * term.change[i];
}

void NewtonOnRows::apply() {
  rows_.apply();
  for (int body = 0; body < problem_->body_count(); ++body)
    std::copy_n(velocity_.data() + matrix_.offset(body), problem_->equations(body).stride(),
                problem_->equations(body).velocity());
}

void NewtonOnRows::multiply_by_inertia(const std::vector<double>& velocities, std::vector<double>& momenta) const {
  momenta.assign(velocities.size(), 0.0);
  for (int body = 0; body < problem_->body_count(); ++body) {
    const std::size_t offset = matrix_.offset(body);
    const std::ptrdiff_t stride = problem_->equations(body).stride();
    for (int r = 0; r < sizes_[at(body)]; ++r)
      momenta[offset + at(r)] =
          dot(inertia_.data() + begin_[at(body)] + r * stride, velocities.data() + offset, stride);
  }
}

double NewtonOnRows::along(const Row& row, const std::vector<double>& velocities) const {
  const double* jacobian = problem_->numbers() + row.numbers;
  double sum = dot(jacobian, velocities.data() + matrix_.offset(row.body_a), row.stride_a);
  if (row.body_b >= 0)
    sum += dot(jacobian + 2 * row.stride_a, velocities.data() + matrix_.offset(row.body_b), row.stride_b);
  return sum;
}

}  // namespace cohort::physics
