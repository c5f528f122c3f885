// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "server/physics/mechanism/mechanism.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

class Equations;
class BodyMotion;
class Problem;
struct Row;

/// Motors, limits, friction and couplings of the joints of one body.
class JointRows {
 public:
  explicit JointRows(const Mechanism& mechanism);

  /// The kind of command to a motor.
  using Control = JointTarget::Kind;

  /// Adds a motor to one dof, with a limited force or torque; at most one for each dof. `max_velocity` applies when it
  /// moves to a position.
  void add_motor(int dof, double max_effort, double max_velocity);
  bool has_motor(int dof) const { return motor_of_[static_cast<std::size_t>(dof)] >= 0; }
  /// Sets the command of a motor; returns whether it changed.
  bool set_target(int dof, Control control, double target) {
    Motor& told = motor(dof);
    const bool is_new = told.control != control || told.target != target;
    told.control = control;
    told.target = target;
    return is_new;
  }
  /// Returns the impulse of the motor over the last step [N s] or [N m s].
  double motor_impulse(int dof) const { return motor(dof).impulse; }

  /// Changes the velocities by the motors with an effort command; call it before adding rows.
  void apply_efforts(Equations& equations, double step);
  void add_rows(Problem& problem, int index, const BodyMotion& body, double step);

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    for (auto& motor : self.motors_) {
      visit(motor.target);
      visit(motor.impulse);
      visit.unusual(motor.control, Control::velocity);
    }
    for (auto& limit : self.limits_) {
      visit(limit.lower_impulse);
      visit(limit.upper_impulse);
    }
    for (auto& friction : self.frictions_) visit(friction.impulse);
    for (auto& impulse : self.follower_impulses_) visit(impulse);
  }

 private:
  struct Motor {
    int dof = 0;
    double max_effort = 0.0;
    double max_velocity = 0.0;
    Control control = Control::velocity;
    double target = 0.0;
    double impulse = 0.0;
    double most_change = 0.0;  // greatest change of the dof's velocity by the motor in this step
  };
  struct Limit {
    int dof = 0;
    double lower_impulse = 0.0;
    double upper_impulse = 0.0;
  };
  struct Friction {
    int dof = 0;
    double impulse = 0.0;
  };
  static double velocity_towards_target(const Motor& motor, const Row& row, const Problem& problem,
                                        const BodyMotion& body, double step);
  Motor& motor(int dof) { return motors_[static_cast<std::size_t>(motor_of_[static_cast<std::size_t>(dof)])]; }
  const Motor& motor(int dof) const {
    return motors_[static_cast<std::size_t>(motor_of_[static_cast<std::size_t>(dof)])];
  }

  std::vector<Motor> motors_;
  std::vector<int> motor_of_;  // by dof, -1: none
  std::vector<Limit> limits_;
  std::vector<Friction> frictions_;
  std::vector<double> follower_impulses_;  // by follower of the mechanism
};

}  // namespace cohort::physics
