#pragma once

#include "server/physics/bullet.hpp"

namespace cohort::physics {

/// Keeps one joint within its range with one-sided rows, as a contact does: inactive until a step could pass the limit.
class JointLimit final : public btMultiBodyConstraint {
 public:
  /// `link`: Bullet's index of the joint's child; either bound may be infinite.
  JointLimit(btMultiBody* body, int link, double lower, double upper);

  void finalizeMultiDof() override {}
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  int getIslandIdA() const override { return -1; }  // islands are our own
  int getIslandIdB() const override { return -1; }
  void debugDraw(btIDebugDraw*) override {}

 private:
  double lower_;
  double upper_;
};

}  // namespace cohort::physics
