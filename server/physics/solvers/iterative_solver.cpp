// SPDX-License-Identifier: Apache-2.0
#include "server/physics/solvers/iterative_solver.hpp"

#include <algorithm>
#include <cmath>

#include "server/physics/solvers/friction_limits.hpp"

namespace cohort::physics {

void SequentialImpulses::start(double share) {
  for (Row& row : rows_) {
    if (row.impulse == 0.0) continue;
    row.impulse *= share;
    apply(row, row.impulse);
  }
}

double SequentialImpulses::pass(bool forwards) {
  double greatest = 0.0;
  const std::size_t count = rows_.size();
  for (std::size_t i = 0; i < count; ++i) greatest = std::max(greatest, turn(forwards ? i : count - 1 - i));
  return greatest;
}

double SequentialImpulses::pass_without_friction(bool forwards) {
  double greatest = 0.0;
  const std::size_t count = rows_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t index = forwards ? i : count - 1 - i;
    if (rows_[index].has_fixed_limits()) greatest = std::max(greatest, turn(index));
  }
  return greatest;
}

inline double SequentialImpulses::turn(std::size_t index) {
  Row& row = rows_[index];
  switch (row.limits) {
    case Row::Limits::fixed: break;
    case Row::Limits::friction: {
      const double limit = limit_of(row);
      row.set_limits(-limit, limit);
      break;
    }
    case Row::Limits::cone: return turn_cone(row, rows_[index + 1]);
    case Row::Limits::coned: return 0.0;
    case Row::Limits::soft:
      return change(row, std::clamp(wanted(row) - row.softness * row.impulse * row.inverse, row.lower, row.upper));
  }
  return change(row, std::clamp(wanted(row), row.lower, row.upper));
}

inline double SequentialImpulses::limit_of(const Row& row) const {
  return limit_of_friction(row, load_on(row, [&](std::size_t i) { return rows_[i].impulse; }));
}

inline double SequentialImpulses::velocity(const Row& row) const {
  const double* jacobian = numbers_ + row.numbers;
  double sum = dot(jacobian, row.velocity_a, row.stride_a);
  if (row.velocity_b != nullptr) sum += dot(jacobian + 2 * row.stride_a, row.velocity_b, row.stride_b);
  return sum;
}

// Returns the impulse that would satisfy the row if it had no limits.
inline double SequentialImpulses::wanted(const Row& row) const {
  return row.impulse + (row.target - velocity(row)) * row.inverse;
}

inline double SequentialImpulses::change(Row& row, double impulse) {
  const double difference = impulse - row.impulse;
  if (difference == 0.0) return 0.0;
  row.impulse = impulse;
  apply(row, difference);
  return row.inverse > 0.0 ? std::abs(difference) / row.inverse : 0.0;
}

inline void SequentialImpulses::apply(const Row& row, double impulse) {
  const double* response = numbers_ + row.numbers + row.stride_a;
  add_scaled(impulse, response, row.velocity_a, row.stride_a);
  if (row.velocity_b != nullptr)
    add_scaled(impulse, response + row.stride_a + row.stride_b, row.velocity_b, row.stride_b);
}

// Solves both directions of the tangent plane at once. Friction must oppose the sliding motion. Both directions
// therefore use the same gain, that of the more compliant one, and an impulse beyond the limit is shortened without a
// change of direction.
double SequentialImpulses::turn_cone(Row& first, Row& second) {
  const double limit = limit_of(first);
  const double inverse = first.cone_inverse;
  double wanted_first = first.impulse + (first.target - velocity(first)) * inverse;
  double wanted_second = second.impulse + (second.target - velocity(second)) * inverse;
  const double squared = wanted_first * wanted_first + wanted_second * wanted_second;
  if (squared > limit * limit) {
    const double share = limit / std::sqrt(squared);
    wanted_first *= share;
    wanted_second *= share;
  }
  return std::max(change(first, wanted_first), change(second, wanted_second));
}

}  // namespace cohort::physics
