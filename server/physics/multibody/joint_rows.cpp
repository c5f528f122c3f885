#include "server/physics/multibody/joint_rows.hpp"

#include <algorithm>
#include <cmath>

#include "server/physics/dynamics/body_motion.hpp"
#include "server/physics/multibody/rows.hpp"
#include "server/physics/world/corrections.hpp"

namespace cohort::physics {
namespace {

// The least share of a motor's braking ability to count on, however much gravity takes of it.
constexpr double least_braking_share = 0.1;

// Returns the greatest velocity from which a joint can come to rest after `way`. It decelerates by b = `braking`
// [1/s^2] times the step h in each step: the sum of v, v - b h, v - 2 b h ... times h is `way`. A way that one step can
// cover is covered in one.
double velocity_to_rest(double way, double braking, double step) {
  const double last = braking * step * step;
  if (!(way > last)) return way / step;
  const double half = 0.5 * braking * step;
  return std::sqrt(half * half + 2.0 * braking * way) - half;
}

}  // namespace

JointRows::JointRows(const Mechanism& mechanism)
    : motor_of_(mechanism.dofs().size(), -1), follower_impulses_(mechanism.followers().size(), 0.0) {
  for (int i = 0; i < mechanism.dof_count(); ++i) {
    const Dof& dof = mechanism.dofs()[static_cast<std::size_t>(i)];
    if (dof.coordinate >= 0 && (std::isfinite(dof.axis.lower) || std::isfinite(dof.axis.upper)))
      limits_.push_back({.dof = i});
    if (dof.axis.friction > 0.0) frictions_.push_back({.dof = i});
  }
}

void JointRows::add_motor(int dof, double max_effort, double max_velocity) {
  motor_of_[static_cast<std::size_t>(dof)] = static_cast<int>(motors_.size());
  motors_.push_back({.dof = dof, .max_effort = max_effort, .max_velocity = max_velocity});
}

void JointRows::apply_efforts(Equations& equations, double step) {
  for (Motor& motor : motors_) {
    if (motor.control != Control::effort) continue;
    motor.impulse = std::clamp(motor.target, -motor.max_effort, motor.max_effort) * step;
    equations.push_dof(motor.dof, motor.impulse);
  }
}

// `row`: the motor's row, with velocities before any impulse of the step.
double JointRows::velocity_towards_target(const Motor& motor, const Row& row, const Problem& problem,
                                          const BodyMotion& body, double step) {
  const Dof& dof = body.mechanism().dofs()[static_cast<std::size_t>(motor.dof)];
  if (dof.coordinate < 0) return 0.0;
  const double way = std::clamp(motor.target, dof.axis.lower, dof.axis.upper) - body.coordinate(dof);
  const double direction = way < 0.0 ? -1.0 : 1.0;
  // Deceleration by the motor less the acceleration by gravity and inertia in this direction.
  const double by_motor = row.inverse > 0.0 ? motor.max_effort / row.inverse : 0.0;
  const double by_others = direction * (problem.velocity(row) - body.velocities()[motor.dof]) / step;
  const double braking = std::max(by_motor - by_others, least_braking_share * by_motor);
  return direction * std::min(motor.max_velocity, velocity_to_rest(direction * way, braking, step));
}

void JointRows::add_rows(Problem& problem, int index, const BodyMotion& body, double step) {
  for (Friction& friction : frictions_) {
    const Dof& dof = body.mechanism().dofs()[static_cast<std::size_t>(friction.dof)];
    const double limit = dof.axis.friction * step;
    problem.add_dof_row(index, friction.dof, &friction.impulse).set_limits(-limit, limit);
  }
  for (Motor& motor : motors_) {
    motor.most_change = 0.0;
    if (motor.control == Control::effort) continue;
    Row& row = problem.add_dof_row(index, motor.dof, &motor.impulse);
    row.target =
        motor.control == Control::velocity ? motor.target : velocity_towards_target(motor, row, problem, body, step);
    row.set_limits(-motor.max_effort * step, motor.max_effort * step);
    motor.most_change = row.inverse > 0.0 ? motor.max_effort * step / row.inverse : 0.0;
  }
  const std::vector<Mechanism::Follower>& followers = body.mechanism().followers();
  for (std::size_t i = 0; i < followers.size(); ++i) {
    const auto& [dof, leader, multiplier, offset] = followers[i];
    const auto coordinate = [&](int of) {
      return body.coordinate(body.mechanism().dofs()[static_cast<std::size_t>(of)]);
    };
    Row& row = problem.add_dofs_row(index, dof, leader, -multiplier, &follower_impulses_[i]);
    row.target = -correction_share * (coordinate(dof) - multiplier * coordinate(leader) - offset) / step;
  }
  // One-sided rows, like a contact: inactive until a step could pass the limit.
  for (Limit& limit : limits_) {
    const Dof& dof = body.mechanism().dofs()[static_cast<std::size_t>(limit.dof)];
    const double position = body.coordinate(dof);
    const double velocity = body.velocities()[limit.dof];
    // Upper bound on the displacement in this step: by the present velocity, by the forces on it, and by its motor.
    const double fastest = std::max(std::abs(velocity), std::abs(problem.equations(index).velocity()[limit.dof]));
    const double by_motor = has_motor(limit.dof) ? motor(limit.dof).most_change : 0.0;
    const double reach = (2.0 * fastest + by_motor) * step + 1e-3;
    // A spring with a damper, as in Connection::add_yielding_rows; infinite where the limit is rigid.
    const double resistance = step * dof.axis.limit_stiffness + dof.axis.limit_damping;
    const bool is_rigid = std::isinf(resistance);
    // Returns the velocity that closes the gap exactly, or corrects a share of an overshoot.
    const auto target = [&](double gap) {
      if (gap > 0.0) return gap / step;
      return is_rigid ? correction_share * gap / step : dof.axis.limit_stiffness * gap / resistance;
    };
    const auto is_near = [&](double gap) { return gap < reach; };
    if (is_near(position - dof.axis.lower)) {
      Row& row = problem.add_dof_row(index, limit.dof, &limit.lower_impulse);
      row.target = -target(position - dof.axis.lower);
      row.set_limits(0.0, unlimited);
      if (!is_rigid) row.soften(1.0 / (step * resistance));
    } else {
      limit.lower_impulse = 0.0;
    }
    if (is_near(dof.axis.upper - position)) {
      Row& row = problem.add_dof_row(index, limit.dof, &limit.upper_impulse);
      row.target = target(dof.axis.upper - position);
      row.set_limits(-unlimited, 0.0);
      if (!is_rigid) row.soften(1.0 / (step * resistance));
    } else {
      limit.upper_impulse = 0.0;
    }
  }
}

}  // namespace cohort::physics
