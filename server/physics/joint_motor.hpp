#pragma once

#include "server/physics/one_body_row.hpp"

namespace cohort::physics {

/// Drives one joint towards a velocity with a limited force or torque. Bullet's own motor passes its body twice and so
/// computes every response twice.
class JointMotor final : public OneBodyConstraint {
 public:
  /// `link`: Bullet's index of the joint's child.
  JointMotor(btMultiBody* body, int link, double max_effort);

  void set_target(double velocity) { target_ = velocity; }
  double target() const { return target_; }

  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  double max_effort_;
  double target_ = 0.0;
};

}  // namespace cohort::physics
