#pragma once

#include "server/physics/one_body_row.hpp"

namespace cohort::physics {

/// Keeps one joint within its range with one-sided rows, as a contact does: inactive until a step could pass the limit.
class JointLimit final : public OneBodyConstraint {
 public:
  /// `link`: Bullet's index of the joint's child; either bound may be infinite.
  JointLimit(btMultiBody* body, int link, double lower, double upper);

  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  double lower_;
  double upper_;
};

}  // namespace cohort::physics
