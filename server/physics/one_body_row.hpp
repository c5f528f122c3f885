#pragma once

#include "server/physics/bullet.hpp"

namespace cohort::physics {

/// What our constraints on one multibody have in common. `impulses`: how many rows it can have; each keeps its impulse
/// for the next step's warm start.
class OneBodyConstraint : public btMultiBodyConstraint {
 public:
  OneBodyConstraint(btMultiBody* body, int link, int impulses, int type)
      : btMultiBodyConstraint(body, nullptr, link, -1, impulses, false, type) {
    m_data.resize(impulses, 0.0);
  }

  void finalizeMultiDof() override {}
  int getIslandIdA() const override { return -1; }  // islands are our own
  int getIslandIdB() const override { return -1; }
  void debugDraw(btIDebugDraw*) override {}
};

/// A solver row that acts on one multibody only, ready but for its limits. `right_hand_side` is to be set with
/// `drive_towards`.
struct OneBodyRow {
  btMultiBodySolverConstraint& row;
  double velocity;  ///< along the row, before the solver runs

  /// The row seeks this velocity with an impulse within [lower, upper].
  void drive_towards(double target, double lower, double upper) {
    row.m_rhs = (target - velocity) * row.m_jacDiagABInv;
    row.m_lowerLimit = lower;
    row.m_upperLimit = upper;
  }
};

/// Adds a row for a force at `point_W` of the root link along the unit vector `direction_W`. `slot`: where `owner`
/// keeps the row's impulse for the next step's warm start.
OneBodyRow add_force_row(btMultiBodyConstraint& owner, btMultiBody& body, const btVector3& point_W,
                         const btVector3& direction_W, int slot, btMultiBodyConstraintArray& rows,
                         btMultiBodyJacobianData& data);

/// Adds a row for the force or torque of the joint of Bullet's link `link`, which has one degree of freedom.
OneBodyRow add_joint_row(btMultiBodyConstraint& owner, btMultiBody& body, int link, int slot,
                         btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data);

}  // namespace cohort::physics
