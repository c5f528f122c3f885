#include "server/physics/joint_limit.hpp"

#include <limits>

namespace cohort::physics {
namespace {

constexpr double correction_share = 0.2;  // of an overshoot, taken away by one step
constexpr double unlimited = std::numeric_limits<double>::max();

}  // namespace

JointLimit::JointLimit(btMultiBody* body, int link, double lower, double upper)
    : OneBodyConstraint(body, link, 2, MULTIBODY_CONSTRAINT_LIMIT), lower_(lower), upper_(upper) {}

void JointLimit::createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                                      const btContactSolverInfo& info) {
  const double position = m_bodyA->getJointPosMultiDof(m_linkA)[0];
  const double velocity = m_bodyA->getJointVelMultiDof(m_linkA)[0];
  // The velocity that just closes the gap, or that takes back a share of an overshoot.
  const auto target = [&](double gap) { return (gap > 0.0 ? gap : correction_share * gap) / info.m_timeStep; };
  const auto is_near = [&](double gap) { return gap < 2.0 * std::abs(velocity) * info.m_timeStep + 1e-3; };
  if (is_near(position - lower_)) {
    add_joint_row(*this, *m_bodyA, m_linkA, 0, rows, data).drive_towards(-target(position - lower_), 0.0, unlimited);
  } else {
    internalSetAppliedImpulse(0, 0.0);
  }
  if (is_near(upper_ - position)) {
    add_joint_row(*this, *m_bodyA, m_linkA, 1, rows, data).drive_towards(target(upper_ - position), -unlimited, 0.0);
  } else {
    internalSetAppliedImpulse(1, 0.0);
  }
}

}  // namespace cohort::physics
