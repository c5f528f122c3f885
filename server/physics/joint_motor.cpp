#include "server/physics/joint_motor.hpp"

namespace cohort::physics {

JointMotor::JointMotor(btMultiBody* body, int link, double max_effort)
    : OneBodyConstraint(body, link, 1, MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR), max_effort_(max_effort) {}

void JointMotor::createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                                      const btContactSolverInfo& info) {
  const double limit = max_effort_ * info.m_timeStep;
  add_joint_row(*this, *m_bodyA, m_linkA, 0, rows, data).drive_towards(target_, -limit, limit);
}

}  // namespace cohort::physics
