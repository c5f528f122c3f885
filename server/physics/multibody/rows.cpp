// SPDX-License-Identifier: Apache-2.0
#include "server/physics/multibody/rows.hpp"

#include <cassert>
#include <cmath>

namespace cohort::physics {

void IslandBodies::reset(std::size_t count) {
  count_ = static_cast<int>(count);
  if (equations_.size() < count) equations_.resize(count);
}

void Problem::clear() {
  rows_.clear();
  numbers_.clear();
}

Row& Problem::begin_row(Anchor a, Anchor b, double* kept) {
  assert(a.body >= 0 && a.body < body_count() && b.body < body_count());
  Row& row = rows_.emplace_back();
  row.kept = kept;
  row.impulse = kept == nullptr ? 0.0 : *kept;
  row.numbers = numbers_.size();
  Equations& body_a = (*bodies_)[a.body];
  row.body_a = a.body;
  row.velocity_a = body_a.velocity();
  row.stride_a = body_a.stride();
  if (b.body >= 0 && b.body != a.body) {
    Equations& body_b = (*bodies_)[b.body];
    row.body_b = b.body;
    row.velocity_b = body_b.velocity();
    row.stride_b = body_b.stride();
  }
  numbers_.resize(row.numbers + 2 * static_cast<std::size_t>(row.stride_a + row.stride_b), 0.0);
  return row;
}

Row& Problem::finish_row(Row& row, Anchor a, Anchor b) {
  assert(&row == &rows_.back());
  double* jacobian_a = numbers_.data() + row.numbers;
  double* response_a = jacobian_a + row.stride_a;
  equations(a.body).respond(jacobian_a, response_a);
  double given = dot(jacobian_a, response_a, row.stride_a);
  if (row.velocity_b != nullptr) {
    double* jacobian_b = response_a + row.stride_a;
    double* response_b = jacobian_b + row.stride_b;
    equations(b.body).respond(jacobian_b, response_b);
    given += dot(jacobian_b, response_b, row.stride_b);
  }
  constexpr double immovable = 1e-12;
  row.inverse = given > immovable ? 1.0 / given : 0.0;
  return row;
}

Row& Problem::add_force_row(Anchor a, Anchor b, const Eigen::Vector3d& point_W, const Eigen::Vector3d& direction_W,
                            double* kept) {
  Row& row = begin_row(a, b, kept);
  row.is_of_force = true;
  double* jacobian_a = numbers_.data() + row.numbers;
  equations(a.body).add_force(a.segment, point_W, direction_W, jacobian_a);
  if (b.body >= 0) {
    double* jacobian_b = b.body == a.body ? jacobian_a : jacobian_a + 2 * row.stride_a;
    equations(b.body).add_force(b.segment, point_W, -direction_W, jacobian_b);
  }
  return finish_row(row, a, b);
}

Row& Problem::add_torque_row(Anchor a, Anchor b, const Eigen::Vector3d& direction_W, double* kept) {
  Row& row = begin_row(a, b, kept);
  double* jacobian_a = numbers_.data() + row.numbers;
  equations(a.body).add_torque(a.segment, direction_W, jacobian_a);
  if (b.body >= 0) {
    double* jacobian_b = b.body == a.body ? jacobian_a : jacobian_a + 2 * row.stride_a;
    equations(b.body).add_torque(b.segment, -direction_W, jacobian_b);
  }
  return finish_row(row, a, b);
}

Row& Problem::add_dof_row(int body, int dof, double* kept) {
  Row& row = begin_row({body}, {}, kept);
  numbers_[row.numbers + static_cast<std::size_t>(dof)] = 1.0;
  return finish_row(row, {body}, {});
}

Row& Problem::add_dofs_row(int body, int dof, int other, double share, double* kept) {
  Row& row = begin_row({body}, {}, kept);
  numbers_[row.numbers + static_cast<std::size_t>(dof)] = 1.0;
  numbers_[row.numbers + static_cast<std::size_t>(other)] = share;
  return finish_row(row, {body}, {});
}

// The response to impulses in the plane is a symmetric matrix; this is its greater eigenvalue.
void Problem::join_to_cone() {
  assert(rows_.size() >= 2);
  Row& second = rows_.back();
  Row& first = rows_[rows_.size() - 2];
  assert(first.body_a == second.body_a && first.body_b == second.body_b);
  first.limits = Row::Limits::cone;
  second.limits = Row::Limits::coned;
  const double* jacobian = numbers_.data() + first.numbers;
  const double* response = numbers_.data() + second.numbers + second.stride_a;
  double coupling = dot(jacobian, response, first.stride_a);
  if (first.velocity_b != nullptr)
    coupling += dot(jacobian + 2 * first.stride_a, response + second.stride_a + second.stride_b, first.stride_b);
  const double by_first = first.inverse > 0.0 ? 1.0 / first.inverse : 0.0;
  const double by_second = second.inverse > 0.0 ? 1.0 / second.inverse : 0.0;
  const double half = 0.5 * (by_first - by_second);
  const double greatest = 0.5 * (by_first + by_second) + std::sqrt(half * half + coupling * coupling);
  first.cone_inverse = greatest > 0.0 ? 1.0 / greatest : 0.0;
}

double Problem::velocity(const Row& row) const {
  const double* jacobian_a = numbers_.data() + row.numbers;
  double sum = dot(jacobian_a, row.velocity_a, row.stride_a);
  if (row.velocity_b != nullptr) sum += dot(jacobian_a + 2 * row.stride_a, row.velocity_b, row.stride_b);
  return sum;
}

double Problem::velocity_before(const Row& row) const {
  const auto sum_of = [&](int body, const double* jacobian) {
    const Equations& of = equations(body);
    double sum = 0.0;
    for (int i = 0; i < of.size(); ++i) sum += jacobian[i] * of.body().velocities()[i];
    return sum;
  };
  const double* jacobian_a = numbers_.data() + row.numbers;
  double sum = sum_of(row.body_a, jacobian_a);
  if (row.velocity_b != nullptr) sum += sum_of(row.body_b, jacobian_a + 2 * row.stride_a);
  return sum;
}

}  // namespace cohort::physics
