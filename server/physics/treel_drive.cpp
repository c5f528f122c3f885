#include "server/physics/treel_drive.hpp"

#include <algorithm>
#include <limits>

#include "server/physics/ground.hpp"

namespace cohort::physics {
namespace {

// Slots of the impulses kept for the warm start: four ground points, two drives, one lateral.
constexpr int drive_slot = 4;
constexpr int lateral_slot = 6;
constexpr int slots = 7;

// A ground point counts from this far above the surface, so that landing is seen before it happens [m].
constexpr double reach = 0.01;
// Share of a ground point's depth that one step takes away, and how fast it may at the most [m/s].
constexpr double correction_share = 0.2;
constexpr double max_correction_velocity = 0.3;
// Rows and doubles that Bullet's arrays hold from the start: they grow one row at a time and copy all of it each time.
constexpr int reserved_rows = 512;

}  // namespace

TreelDrive::TreelDrive(btMultiBody* body, std::uint32_t body_index, const description::TreelDrive& drive,
                       const Pose& X_BL, const geometry::Scene& scene)
    : OneBodyConstraint(body, -1, slots, type),
      body_index_(body_index),
      drive_(drive),
      X_BL_(X_BL),
      scene_(&scene),
      forward_W_(0, 0, 0),
      normal_W_(0, 0, 0) {}

void TreelDrive::createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                                      const btContactSolverInfo& info) {
  add_normal_rows(rows, data, info.m_timeStep);

  lateral_row_ = -1;
  if (!normal_W_.isZero()) {
    const btTransform X_WB = m_bodyA->getBaseWorldTransform();
    const btTransform X_WL = X_WB * to_bullet(X_BL_);
    const btVector3 x_W = X_WL.getBasis().getColumn(0);
    forward_W_ = (x_W - normal_W_ * normal_W_.dot(x_W)).normalized();
    const btVector3 lateral_W = normal_W_.cross(forward_W_);
    motor_limit_ = drive_.max_torque / drive_.wheel_radius * info.m_timeStep;

    for (const Side side : {Side::left, Side::right}) {
      Track& track = side_of(side);
      const double y = side == Side::left ? drive_.half_gauge : -drive_.half_gauge;
      track.point_W = X_WL * btVector3(0.0, y, drive_.ground_height);
      if (track.normal_rows[0] < 0) continue;
      track.row = rows.size();
      add_force_row(*this, *m_bodyA, track.point_W, forward_W_, drive_slot + static_cast<int>(side), rows, data)
          .drive_towards(track.target, -motor_limit_, motor_limit_);
    }
    lateral_row_ = rows.size();
    add_force_row(*this, *m_bodyA, X_WL * btVector3(0.0, 0.0, drive_.ground_height), lateral_W, lateral_slot, rows,
                  data)
        .drive_towards(0.0, 0.0, 0.0);
  }

  // What has no row now must not start the next step with an old impulse.
  for (const Side side : {Side::left, Side::right})
    if (side_of(side).row < 0) internalSetAppliedImpulse(drive_slot + static_cast<int>(side), 0.0);
  if (lateral_row_ < 0) internalSetAppliedImpulse(lateral_slot, 0.0);
}

void TreelDrive::add_normal_rows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data, double step) {
  const btTransform X_WB = m_bodyA->getBaseWorldTransform();
  const btTransform X_WL = X_WB * to_bullet(X_BL_);
  const Eigen::Vector3d up_W = to_eigen(X_WL.getBasis().getColumn(2));
  const Eigen::Vector3d centre_W = to_eigen(X_WL * btVector3(0.0, 0.0, drive_.ground_height));
  const GroundFinder ground_finder(*scene_, body_index_, centre_W, drive_.half_gauge + drive_.half_contact_length, up_W,
                                   drive_.wheel_radius, reach);
  btVector3 normal_sum(0, 0, 0);
  int slot = 0;
  for (const Side side : {Side::left, Side::right}) {
    Track& track = side_of(side);
    track.row = -1;
    track.normal_rows = {-1, -1};
    track.friction = drive_.friction;
    std::size_t touching = 0;
    for (const double along : {drive_.half_contact_length, -drive_.half_contact_length}) {
      const double y = side == Side::left ? drive_.half_gauge : -drive_.half_gauge;
      const btVector3 point_W = X_WL * btVector3(along, y, drive_.ground_height);
      const auto ground = ground_finder.below(to_eigen(point_W));
      if (ground) {
        // Above the surface: may close the gap within the step. Below: pushed out gently.
        const double target = ground->gap > 0.0
                                  ? -ground->gap / step
                                  : std::min(max_correction_velocity, -ground->gap * correction_share / step);
        const btVector3 normal_W = to_bullet(ground->normal_W);
        track.normal_rows[touching++] = rows.size();
        track.friction = std::min(track.friction, ground->friction);
        normal_sum += normal_W;
        add_force_row(*this, *m_bodyA, point_W, normal_W, slot, rows, data)
            .drive_towards(target, 0.0, std::numeric_limits<double>::max());
      } else {
        internalSetAppliedImpulse(slot, 0.0);
      }
      ++slot;
    }
  }
  normal_W_ = normal_sum.isZero() ? normal_sum : normal_sum.normalized();
}

void TreelDrive::limit_traction(btMultiBodyConstraintArray& rows) const {
  double lateral_limit = 0.0;
  for (const Track& track : tracks_) {
    if (track.row < 0) continue;
    double load = 0.0;
    for (const int row : track.normal_rows)
      if (row >= 0) load += rows[row].m_appliedImpulse;
    const double grip = track.friction * load;
    lateral_limit += grip;
    const double limit = std::min(grip, motor_limit_);
    rows[track.row].m_lowerLimit = -limit;
    rows[track.row].m_upperLimit = limit;
  }
  if (lateral_row_ >= 0) {
    rows[lateral_row_].m_lowerLimit = -lateral_limit;
    rows[lateral_row_].m_upperLimit = lateral_limit;
  }
}

void TreelDrive::advance_tracks(double step) {
  const btVector3 origin_W = m_bodyA->getBasePos();
  const btVector3 linear_W = m_bodyA->getBaseVel();
  const btVector3 angular_W = m_bodyA->getBaseOmega();
  double load_left = 0.0;
  for (int slot = 0; slot < 2; ++slot) load_left += getAppliedImpulse(slot);
  double load_right = 0.0;
  for (int slot = 2; slot < 4; ++slot) load_right += getAppliedImpulse(slot);
  for (const Side side : {Side::left, Side::right}) {
    Track& track = side_of(side);
    const double impulse = track.row < 0 ? 0.0 : getAppliedImpulse(drive_slot + static_cast<int>(side));
    const double grip = track.friction * (side == Side::left ? load_left : load_right);
    // A track that slips or hangs in the air turns as commanded; one that grips turns as the ground goes by.
    const bool slips = track.row < 0 || (grip < motor_limit_ && std::abs(impulse) >= grip);
    track.state.velocity = slips ? track.target : forward_W_.dot(linear_W + angular_W.cross(track.point_W - origin_W));
    track.state.position += track.state.velocity * step;
    track.state.traction = impulse / step;
  }
}

TreelSolver::TreelSolver() {
  constexpr int dofs = 16;
  m_data.m_jacobians.reserve(reserved_rows * dofs);
  m_data.m_deltaVelocitiesUnitImpulse.reserve(reserved_rows * dofs);
  m_data.m_deltaVelocities.reserve(reserved_rows);
  m_multiBodyNonContactConstraints.reserve(reserved_rows);
}

btScalar TreelSolver::solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                           btPersistentManifold** manifolds, int manifold_count,
                                           btTypedConstraint** constraints, int constraint_count,
                                           const btContactSolverInfo& info, btIDebugDraw* draw) {
  for (int i = 0; i < m_tmpNumMultiBodyConstraints; ++i)
    if (m_tmpMultiBodyConstraints[i]->getConstraintType() == TreelDrive::type)
      static_cast<const TreelDrive*>(m_tmpMultiBodyConstraints[i])->limit_traction(m_multiBodyNonContactConstraints);
  return btMultiBodyConstraintSolver::solveSingleIteration(iteration, bodies, body_count, manifolds, manifold_count,
                                                           constraints, constraint_count, info, draw);
}

}  // namespace cohort::physics
