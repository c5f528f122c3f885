#pragma once

#include <cstdint>
#include <vector>

#include "server/physics/mechanism.hpp"

namespace cohort::physics {

class Multibody;
class Problem;

/// Motors, limits and friction of the joints of one body.
class JointRows {
 public:
  explicit JointRows(const Mechanism& mechanism);

  /// A motor on one dof that drives it towards a velocity with a limited force or torque. At most one for each dof.
  void add_motor(int dof, double max_effort);
  bool has_motor(int dof) const { return motor_of_[static_cast<std::size_t>(dof)] >= 0; }
  void set_target(int dof, double velocity) { motor(dof).target = velocity; }
  /// Impulse of the motor over the last step [N s] or [N m s].
  double motor_impulse(int dof) const { return motor(dof).impulse; }

  void add_rows(Problem& problem, int index, const Multibody& body, double step);

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    for (auto& motor : self.motors_) {
      visit(motor.target);
      visit(motor.impulse);
    }
    for (auto& limit : self.limits_) {
      visit(limit.lower_impulse);
      visit(limit.upper_impulse);
    }
    for (auto& friction : self.frictions_) visit(friction.impulse);
  }

 private:
  struct Motor {
    int dof = 0;
    double max_effort = 0.0;
    double target = 0.0;
    double impulse = 0.0;
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
  Motor& motor(int dof) { return motors_[static_cast<std::size_t>(motor_of_[static_cast<std::size_t>(dof)])]; }
  const Motor& motor(int dof) const {
    return motors_[static_cast<std::size_t>(motor_of_[static_cast<std::size_t>(dof)])];
  }

  std::vector<Motor> motors_;
  std::vector<int> motor_of_;  // by dof, -1: none
  std::vector<Limit> limits_;
  std::vector<Friction> frictions_;
};

}  // namespace cohort::physics
