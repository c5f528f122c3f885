#pragma once

#include "server/physics/bullet.hpp"

namespace cohort::physics {

/// Drives one joint towards a velocity with a limited force or torque. Bullet's own motor passes its body twice and so
/// computes every response twice.
class JointMotor final : public btMultiBodyConstraint {
 public:
  /// `link`: Bullet's index of the joint's child.
  JointMotor(btMultiBody* body, int link, double max_effort);

  void set_target(double velocity) { target_ = velocity; }
  double target() const { return target_; }

  void finalizeMultiDof() override {}
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  int getIslandIdA() const override { return -1; }  // islands are our own
  int getIslandIdB() const override { return -1; }
  void debugDraw(btIDebugDraw*) override {}

 private:
  double max_effort_;
  double target_ = 0.0;
};

}  // namespace cohort::physics
