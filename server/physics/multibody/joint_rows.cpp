// SPDX-License-Identifier: Apache-2.0
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

// Returns the velocity that the spring of an elastic limit would give to `mass` if no other force acted in this step.
// `velocity`: that before the step, away from the limit. Velocities belong to the middle of steps, so that the joint is
// at gap - step velocity / 2 with the one, and at gap + step velocity / 2 with the other. The kinetic energy and that
// of the spring have the same sum at these places: the limit gives back what it has taken.
double rebound_from_spring(double stiffness, double mass, double gap, double velocity, double step) {
  const double before = gap - 0.5 * step * velocity;
  const double inertia = mass + 0.25 * step * step * stiffness;
  if (before < 0.0) {
    const double within = velocity - step * stiffness * gap / inertia;
    if (gap + 0.5 * step * within < 0.0) return within;
    return std::sqrt(velocity * velocity + stiffness * before * before / mass);
  }
  const double half = 0.5 * stiffness * step * gap;
  const double rest = stiffness * gap * gap - mass * velocity * velocity;
  return -(half + std::sqrt(std::max(0.0, half * half - inertia * rest))) / inertia;
}

// Makes the row one of a joint limit, and returns its target away from the limit. `gap`: to the limit; `velocity`: of
// the joint before the step, away from the limit.
double limit_row(Row& row, const description::JointAxis& axis, double gap, double velocity, double step) {
  const double resistance = step * axis.limit_stiffness + axis.limit_damping;
  // Closes the gap exactly, or corrects a share of an overshoot.
  if (std::isinf(resistance)) return -(gap > 0.0 ? gap : correction_share * gap) / step;
  const double mass = row.inverse;
  if (axis.limit_stiffness * step * step > fastest_spring * mass) {
    // A spring with a damper, as in Connection::add_yielding_rows.
    row.soften(1.0 / (step * resistance));
    return -(gap > 0.0 ? gap / step : axis.limit_stiffness * gap / resistance);
  }
  if (gap >= 0.5 * step * std::abs(velocity)) {  // the joint does not meet it in this step
    row.set_limits(0.0, 0.0);
    return velocity;
  }
  const double rebound = rebound_from_spring(axis.limit_stiffness, mass, gap, velocity, step);
  const double by_spring = 0.25 * step * step * axis.limit_stiffness;
  row.soften(1.0 / (by_spring + step * axis.limit_damping));
  return row.softness * (mass * (rebound - velocity) + by_spring * rebound);
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
    const auto add = [&](double gap, double sense, double* kept) {
      if (gap >= reach) {
        *kept = 0.0;
        return;
      }
      Row& row = problem.add_dof_row(index, limit.dof, kept);
      sense > 0.0 ? row.set_limits(0.0, unlimited) : row.set_limits(-unlimited, 0.0);
      row.target = sense * limit_row(row, dof.axis, gap, sense * velocity, step);
    };
    add(position - dof.axis.lower, 1.0, &limit.lower_impulse);
    add(dof.axis.upper - position, -1.0, &limit.upper_impulse);
  }
}

}  // namespace cohort::physics
