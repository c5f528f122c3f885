#include "server/physics/iterative_solver.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::physics {
namespace {

class Pass {
 public:
  explicit Pass(Problem& problem) : rows_(problem.rows()), numbers_(problem.numbers()) {}

  void start() {
    for (Row& row : rows_)
      if (row.impulse != 0.0) apply(row, row.impulse);
  }

  // Returns the greatest change of a row's velocity.
  double run() {
    double greatest = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      Row& row = rows_[i];
      switch (row.limits) {
        case Row::Limits::fixed: break;
        case Row::Limits::friction: {
          const double limit = limit_of(row);
          row.set_limits(-limit, limit);
          break;
        }
        case Row::Limits::cone:
          greatest = std::max(greatest, turn_cone(row, rows_[i + 1]));
          ++i;
          continue;
      }
      greatest = std::max(greatest, change(row, std::clamp(wanted(row), row.lower, row.upper)));
    }
    return greatest;
  }

 private:
  double limit_of(const Row& row) const {
    double load = 0.0;
    for (int i = row.load_begin; i < row.load_end; ++i) load += rows_[static_cast<std::size_t>(i)].impulse;
    return std::min(row.cap, row.friction * load);
  }

  // The impulse with which the row would be met, were there no limits.
  double wanted(const Row& row) const {
    const double* jacobian = numbers_ + row.numbers;
    double velocity = dot(jacobian, row.velocity_a, row.stride_a);
    if (row.velocity_b != nullptr) velocity += dot(jacobian + 2 * row.stride_a, row.velocity_b, row.stride_b);
    return row.impulse + (row.target - velocity - row.softness * row.impulse) * row.inverse;
  }

  double change(Row& row, double impulse) {
    const double difference = impulse - row.impulse;
    if (difference == 0.0) return 0.0;
    row.impulse = impulse;
    apply(row, difference);
    return row.inverse > 0.0 ? std::abs(difference) / row.inverse : 0.0;
  }

  void apply(const Row& row, double impulse) {
    const double* response = numbers_ + row.numbers + row.stride_a;
    add_scaled(impulse, response, row.velocity_a, row.stride_a);
    if (row.velocity_b != nullptr)
      add_scaled(impulse, response + row.stride_a + row.stride_b, row.velocity_b, row.stride_b);
  }

  // Both directions of the tangent plane: each as if alone, then the two back onto the disc.
  double turn_cone(Row& first, Row& second) {
    const double limit = limit_of(first);
    double greatest = change(first, std::clamp(wanted(first), -limit, limit));
    greatest = std::max(greatest, change(second, std::clamp(wanted(second), -limit, limit)));
    const double squared = first.impulse * first.impulse + second.impulse * second.impulse;
    if (squared <= limit * limit) return greatest;
    const double share = limit / std::sqrt(squared);
    change(first, share * first.impulse);
    change(second, share * second.impulse);
    return greatest;
  }

  std::vector<Row>& rows_;
  const double* numbers_;
};

}  // namespace

int solve_iteratively(Problem& problem, std::uint32_t iterations, double tolerance) {
  Pass pass(problem);
  pass.start();
  for (std::uint32_t i = 1; i <= iterations; ++i)
    if (pass.run() <= tolerance) return static_cast<int>(i);
  return static_cast<int>(iterations);
}

}  // namespace cohort::physics
