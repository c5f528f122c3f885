// SPDX-License-Identifier: Apache-2.0
#include "server/physics/mechanism/bullet_body.hpp"

#include <algorithm>
#include <limits>

#include "server/physics/contact/bullet.hpp"

namespace cohort::physics {
namespace {

constexpr int base_dofs = 6;

struct Scratch {
  btAlignedObjectArray<btScalar> numbers;
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btMatrix3x3> matrices;
  std::vector<double> force;
  std::vector<double> response;
};

// Returns the scratch memory of this worker, for all bodies on which it works one after the other.
Scratch& scratch_of_thread() {
  static thread_local Scratch scratch;
  return scratch;
}

btVector3 diagonal_of(const Segment& segment) { return to_bullet(Eigen::Vector3d(segment.inertia_S.diagonal())); }

void set_up_link(btMultiBody& body, int link, int parent, const Segment& segment,
                 const Eigen::Vector3d& parents_centre) {
  const btQuaternion to_this = to_bullet(segment.X_PS.orientation.conjugate());
  const btVector3 to_pivot = to_bullet(Eigen::Vector3d(segment.X_PS.position - parents_centre));
  const btVector3 to_centre = to_bullet(segment.centre_S);
  const btVector3 axis = to_bullet(segment.axis_S);
  const btVector3 inertia = diagonal_of(segment);
  switch (segment.motion) {
    case Motion::free: break;
    case Motion::anchored: body.setupFixed(link, segment.mass, inertia, parent, to_this, to_pivot, to_centre); break;
    case Motion::revolute:
      body.setupRevolute(link, segment.mass, inertia, parent, to_this, axis, to_pivot, to_centre, true);
      break;
    case Motion::prismatic:
      body.setupPrismatic(link, segment.mass, inertia, parent, to_this, axis, to_pivot, to_centre, true);
      break;
    case Motion::ball:
      body.setupSpherical(link, segment.mass, inertia, parent, to_this, to_pivot, to_centre, true);
      break;
  }
}

}  // namespace

BulletBody::BulletBody(const Mechanism& mechanism)
    : mechanism_(&mechanism),
      first_link_(mechanism.has_free_root() ? 1 : 0),
      first_dof_(mechanism.has_free_root() ? 0 : base_dofs) {
  const std::vector<Segment>& segments = mechanism.segments();
  const Segment& root = segments[0];
  const auto links = static_cast<int>(segments.size()) - first_link_;
  const bool is_free = mechanism.has_free_root();
  body_ = std::make_unique<btMultiBody>(links, is_free ? root.mass : 0.0,
                                        is_free ? diagonal_of(root) : btVector3(0, 0, 0), !is_free, false);
  body_->setLinearDamping(0.0);
  body_->setAngularDamping(0.0);
  body_->setMaxCoordinateVelocity(std::numeric_limits<double>::max());
  // `integrate` (dynamics/integration.hpp) handles the rotation of a free rigid body.
  body_->setUseGyroTerm(!mechanism.is_free_body());
  for (int link = 0; link < links; ++link) {
    const Segment& segment = segments[at(link + first_link_)];
    const Eigen::Vector3d parents_centre =
        segment.parent < 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : segments[at(segment.parent)].centre_S;
    set_up_link(*body_, link, segment.parent - first_link_, segment, parents_centre);
  }
  body_->finalizeMultiDof();
}

BulletBody::~BulletBody() = default;

// Bullet exposes its state as const to users of its bodies; here the state is written on purpose.
BodyState::Memory BulletBody::memory() {
  BodyState::Memory memory;
  memory.reference = const_cast<double*>(body_->getBasePos().m_floats);
  memory.rotation = const_cast<double*>(&body_->getWorldToBaseRot().x());
  memory.is_from_world = true;
  memory.velocities = const_cast<double*>(body_->getVelocityVector()) + first_dof_;
  for (int link = 0; link < body_->getNumLinks(); ++link)
    for (int i = 0; i < body_->getLink(link).m_posVarCount; ++i)
      memory.coordinates.push_back(&body_->getLink(link).m_jointPos[i]);
  return memory;
}

// Updates Bullet's caches from poses that are the same on any CPU.
void BulletBody::place_links(const std::vector<Pose>& X_WS) {
  const btQuaternion& base = body_->getWorldToBaseRot();
  for (std::size_t s = at(first_link_); s < X_WS.size(); ++s) {
    const Segment& segment = mechanism_->segments()[s];
    btMultibodyLink& link = body_->getLink(static_cast<int>(s) - first_link_);
    const Eigen::Quaterniond to_this = X_WS[s].orientation.conjugate();
    const Eigen::Vector3d centre_W = X_WS[s] * segment.centre_S;
    if (segment.parent < 0) {  // a base that is fixed, at the origin
      link.m_cachedRotParentToThis = to_bullet(to_this) * base.inverse();
      link.m_cachedRVector = to_bullet(Eigen::Vector3d(to_this * centre_W));
      continue;
    }
    const Pose& X_WP = X_WS[at(segment.parent)];
    link.m_cachedRotParentToThis = to_bullet(Eigen::Quaterniond(to_this * X_WP.orientation));
    link.m_cachedRVector =
        to_bullet(Eigen::Vector3d(to_this * (centre_W - X_WP * mechanism_->segments()[at(segment.parent)].centre_S)));
  }
}

// Returns the response of the base's acceleration to a torque and a force on it, in world axes. Bullet leaves the
// articulated-body inertia of the base, in its axes, in the memory that it is given. Its blocks are: force per angular
// acceleration, force per linear acceleration, and torque per angular acceleration.
Eigen::Matrix<double, 6, 6> BulletBody::response_of_base(const btAlignedObjectArray<btMatrix3x3>& left) const {
  const int first = body_->getNumLinks() + 1;
  const Eigen::Matrix3d R = to_eigen(body_->getWorldToBaseRot()).conjugate().toRotationMatrix();
  const auto in_world = [&](int which) -> Eigen::Matrix3d { return R * to_eigen(left[first + which]) * R.transpose(); };
  const Eigen::Matrix3d force_by_turning = in_world(0);
  const Eigen::Matrix3d moving_by_force = in_world(1).inverse();
  const Eigen::Matrix3d moving_by_turning = moving_by_force * force_by_turning;
  Eigen::Matrix<double, 6, 6> response;
  response.topLeftCorner<3, 3>() = (in_world(2) - force_by_turning.transpose() * moving_by_turning).inverse();
  response.bottomLeftCorner<3, 3>() = -moving_by_turning * response.topLeftCorner<3, 3>();
  response.topRightCorner<3, 3>() = response.bottomLeftCorner<3, 3>().transpose();
  response.bottomRightCorner<3, 3>() =
      moving_by_force - response.bottomLeftCorner<3, 3>() * moving_by_turning.transpose();
  return response;
}

void BulletBody::solve(const std::vector<Pose>& X_WS, const Eigen::Vector3d& gravity, const double* efforts,
                       double step, double* change, double* responses) {
  Scratch& scratch = scratch_of_thread();
  const std::vector<Segment>& segments = mechanism_->segments();
  const int size = mechanism_->dof_count();
  place_links(X_WS);

  body_->clearForcesAndTorques();
  if (first_link_ == 1) body_->addBaseForce(to_bullet(Eigen::Vector3d(segments[0].mass * gravity)));
  for (std::size_t s = at(first_link_); s < segments.size(); ++s) {
    const int link = static_cast<int>(s) - first_link_;
    body_->addLinkForce(link, to_bullet(Eigen::Vector3d(segments[s].mass * gravity)));
    for (int i = 0; i < segments[s].dofs; ++i)
      body_->addJointTorqueMultiDof(link, i, efforts[segments[s].first_dof + i]);
  }

  double* const velocities = const_cast<double*>(body_->getVelocityVector()) + first_dof_;
  scratch.response.assign(velocities, velocities + size);
  body_->computeAccelerationsArticulatedBodyAlgorithmMultiDof(step, scratch.numbers, scratch.vectors, scratch.matrices,
                                                              false, false, false);
  for (int i = 0; i < size; ++i) change[i] = velocities[i] - scratch.response[at(i)];
  std::copy_n(scratch.response.data(), size, velocities);
  if (responses == nullptr) return;

  // Compute the joints one by one. Those of the base come from its own inertia, which Bullet would otherwise invert for
  // each column.
  const std::ptrdiff_t stride = mechanism_->stride();
  const int first_joint = base_dofs - first_dof_;
  scratch.force.assign(at(first_dof_ + size), 0.0);
  scratch.response.assign(at(first_dof_ + size), 0.0);
  for (int i = first_joint; i < size; ++i) {
    scratch.force[at(first_dof_ + i)] = 1.0;
    body_->calcAccelerationDeltasMultiDof(scratch.force.data(), scratch.response.data(), scratch.numbers,
                                          scratch.vectors);
    scratch.force[at(first_dof_ + i)] = 0.0;
    std::copy_n(scratch.response.data() + first_dof_, size, responses + i * stride);
  }
  if (first_joint == 0) return;
  const Eigen::Matrix<double, base_dofs, base_dofs> of_base = response_of_base(scratch.matrices);
  for (int i = 0; i < base_dofs; ++i) {
    Eigen::Map<Eigen::Matrix<double, base_dofs, 1>>(responses + i * stride) = of_base.col(i);
    for (int k = base_dofs; k < size; ++k) responses[i * stride + k] = responses[k * stride + i];
  }
}

}  // namespace cohort::physics
