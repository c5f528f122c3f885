#include "server/physics/joint_rows.hpp"

#include <cmath>

#include "server/physics/multibody.hpp"
#include "server/physics/rows.hpp"

namespace cohort::physics {
namespace {

constexpr double correction_share = 0.2;  // of an overshoot, taken away by one step

}  // namespace

JointRows::JointRows(const Mechanism& mechanism) : motor_of_(mechanism.dofs().size(), -1) {
  for (int i = 0; i < mechanism.dof_count(); ++i) {
    const Dof& dof = mechanism.dofs()[static_cast<std::size_t>(i)];
    if (dof.coordinate >= 0 && (std::isfinite(dof.axis.lower) || std::isfinite(dof.axis.upper)))
      limits_.push_back({.dof = i});
    if (dof.axis.friction > 0.0) frictions_.push_back({.dof = i});
  }
}

void JointRows::add_motor(int dof, double max_effort) {
  motor_of_[static_cast<std::size_t>(dof)] = static_cast<int>(motors_.size());
  motors_.push_back({.dof = dof, .max_effort = max_effort});
}

void JointRows::add_rows(Problem& problem, int index, const Multibody& body, double step) {
  for (Friction& friction : frictions_) {
    const Dof& dof = body.mechanism().dofs()[static_cast<std::size_t>(friction.dof)];
    const double limit = dof.axis.friction * step;
    problem.add_dof_row(index, friction.dof, &friction.impulse).set_limits(-limit, limit);
  }
  for (Motor& motor : motors_) {
    Row& row = problem.add_dof_row(index, motor.dof, &motor.impulse);
    row.target = motor.target;
    row.set_limits(-motor.max_effort * step, motor.max_effort * step);
  }
  // One-sided rows, as a contact is: inactive until a step could pass the limit.
  for (Limit& limit : limits_) {
    const Dof& dof = body.mechanism().dofs()[static_cast<std::size_t>(limit.dof)];
    const double position = body.coordinates()[dof.coordinate];
    const double velocity = body.velocities()[limit.dof];
    // The velocity that just closes the gap, or that takes back a share of an overshoot.
    const auto target = [&](double gap) { return (gap > 0.0 ? gap : correction_share * gap) / step; };
    const auto is_near = [&](double gap) { return gap < 2.0 * std::abs(velocity) * step + 1e-3; };
    if (is_near(position - dof.axis.lower)) {
      Row& row = problem.add_dof_row(index, limit.dof, &limit.lower_impulse);
      row.target = -target(position - dof.axis.lower);
      row.set_limits(0.0, unlimited);
    } else {
      limit.lower_impulse = 0.0;
    }
    if (is_near(dof.axis.upper - position)) {
      Row& row = problem.add_dof_row(index, limit.dof, &limit.upper_impulse);
      row.target = target(dof.axis.upper - position);
      row.set_limits(-unlimited, 0.0);
    } else {
      limit.upper_impulse = 0.0;
    }
  }
}

}  // namespace cohort::physics
