#include "server/physics/one_body_row.hpp"

#include <algorithm>

namespace cohort::physics {
namespace {

// Appends a row with every field set: Bullet hands out rows with stale contents.
btMultiBodySolverConstraint& append(btMultiBodyConstraint& owner, btMultiBody& body, int link, int slot,
                                    btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data) {
  btMultiBodySolverConstraint& row = rows.expandNonInitializing();
  row.m_orgConstraint = &owner;
  row.m_orgDofIndex = slot;
  row.m_multiBodyA = &body;
  row.m_multiBodyB = nullptr;
  row.m_linkA = link;
  row.m_linkB = -1;
  row.m_solverBodyIdA = -1;
  row.m_solverBodyIdB = -1;
  row.m_jacBindex = -1;
  row.m_deltaVelBindex = -1;
  row.m_frictionIndex = -1;
  row.m_friction = 0.0;
  row.m_originalContactPoint = nullptr;
  row.m_overrideNumSolverIterations = 0;
  row.m_appliedImpulse = 0.0;
  row.m_appliedPushImpulse = 0.0;
  row.m_cfm = 0.0;
  row.m_rhsPenetration = 0.0;
  row.m_contactNormal1.setZero();
  row.m_contactNormal2.setZero();
  row.m_relpos1CrossNormal.setZero();
  row.m_relpos2CrossNormal.setZero();
  row.m_angularComponentA.setZero();
  row.m_angularComponentB.setZero();

  const int dofs = body.getNumDofs() + 6;
  row.m_deltaVelAindex = body.getCompanionId();
  if (row.m_deltaVelAindex < 0) {  // the body's first row of this step
    row.m_deltaVelAindex = data.m_deltaVelocities.size();
    body.setCompanionId(row.m_deltaVelAindex);
    data.m_deltaVelocities.resize(row.m_deltaVelAindex + dofs, 0.0);
    std::fill_n(&data.m_deltaVelocities[row.m_deltaVelAindex], dofs, 0.0);
  }
  row.m_jacAindex = data.m_jacobians.size();
  data.m_jacobians.resize(row.m_jacAindex + dofs);
  data.m_deltaVelocitiesUnitImpulse.resize(row.m_jacAindex + dofs);
  std::fill_n(&data.m_jacobians[row.m_jacAindex], dofs, 0.0);
  return row;
}

// With the Jacobian in place: the response to a unit impulse, the effective mass and the velocity along the row.
OneBodyRow complete(btMultiBodySolverConstraint& row, btMultiBody& body, btMultiBodyJacobianData& data) {
  const btScalar* jacobian = &data.m_jacobians[row.m_jacAindex];
  btScalar* response = &data.m_deltaVelocitiesUnitImpulse[row.m_jacAindex];
  body.calcAccelerationDeltasMultiDof(jacobian, response, data.scratch_r, data.scratch_v);
  const btScalar* velocities = body.getVelocityVector();
  double inverse_mass = 0.0;
  double velocity = 0.0;
  for (int i = 0; i < body.getNumDofs() + 6; ++i) {
    inverse_mass += jacobian[i] * response[i];
    velocity += jacobian[i] * velocities[i];
  }
  row.m_jacDiagABInv = inverse_mass > 1e-12 ? 1.0 / inverse_mass : 0.0;
  return {row, velocity};
}

}  // namespace

OneBodyRow add_force_row(btMultiBodyConstraint& owner, btMultiBody& body, const btVector3& point_W,
                         const btVector3& direction_W, int slot, btMultiBodyConstraintArray& rows,
                         btMultiBodyJacobianData& data) {
  btMultiBodySolverConstraint& row = append(owner, body, -1, slot, rows, data);
  const btVector3 moment = (point_W - body.getBasePos()).cross(direction_W);
  btScalar* jacobian = &data.m_jacobians[row.m_jacAindex];
  for (int i = 0; i < 3; ++i) {
    jacobian[i] = moment[i];
    jacobian[3 + i] = direction_W[i];
  }
  row.m_contactNormal1 = direction_W;
  row.m_relpos1CrossNormal = moment;
  return complete(row, body, data);
}

OneBodyRow add_joint_row(btMultiBodyConstraint& owner, btMultiBody& body, int link, int slot,
                         btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data) {
  btMultiBodySolverConstraint& row = append(owner, body, link, slot, rows, data);
  data.m_jacobians[row.m_jacAindex + 6 + body.getLink(link).m_dofOffset] = 1.0;
  return complete(row, body, data);
}

}  // namespace cohort::physics
