// SPDX-License-Identifier: Apache-2.0
#include "server/physics/dynamics/articulated_body.hpp"

namespace cohort::physics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int free_root = 6;  // its degrees of freedom

}  // namespace

void ArticulatedBody::set_up(const BodyMotion& body, const std::vector<double>& added_inertia, double share) {
  share_ = share;
  const Mechanism& mechanism = body.mechanism();
  parts_.resize(mechanism.segments().size());
  changes_.resize(parts_.size());
  axes_.resize(6, mechanism.dof_count());
  drifts_.resize(6, mechanism.dof_count());
  forces_.resize(6, mechanism.dof_count());
  inverses_.resize(6, mechanism.dof_count());
  shares_.resize(12, mechanism.dof_count());
  move_outwards(body);
  for (std::size_t s = parts_.size(); s-- > 0;) {
    Part& part = parts_[s];
    switch (part.dofs) {
      case 1: eliminate<1>(part, added_inertia); break;
      case 3: eliminate<3>(part, added_inertia); break;
      case 6: eliminate<6>(part, added_inertia); break;
      default: break;  // an anchored root does not move
    }
  }
}

// Computes velocities, axes, and the forces of the segments alone, from the root to the leaves.
void ArticulatedBody::move_outwards(const BodyMotion& body) {
  const std::vector<Segment>& segments = body.mechanism().segments();
  for (std::size_t s = 0; s < parts_.size(); ++s) {
    const Segment& segment = segments[s];
    const Pose& X_WS = body.segment_pose(static_cast<int>(s));
    Part& part = parts_[s];
    part.parent = segment.parent;
    part.first_dof = segment.first_dof;
    part.dofs = segment.dofs;
    part.point_W = segment.motion == Motion::free ? body.reference() : X_WS.position;
    part.way_W.setZero();
    part.velocity.setZero();
    if (segment.parent >= 0) {
      const Part& parent = parts_[at(segment.parent)];
      part.way_W = part.point_W - parent.point_W;
      part.velocity = parent.velocity;
      part.velocity.tail<3>() += parent.velocity.head<3>().cross(part.way_W);
    }
    const Matrix3d R = X_WS.orientation.toRotationMatrix();
    for (int i = 0; i < part.dofs; ++i) {
      const Spatial axis = axis_of_joint(segment, R, i);
      axes_.col(part.first_dof + i) << axis.angular, axis.linear;
    }
    part.joint_velocity.setZero();
    for (int i = part.first_dof; i < part.first_dof + part.dofs; ++i)
      part.joint_velocity += body.velocities()[i] * axes_.col(i);
    find_drifts(part);
    part.velocity += part.joint_velocity;
    const auto& added_masses = body.mechanism().added_masses();
    find_force(segment, X_WS, R, added_masses.empty() ? nullptr : &added_masses[s], part);
  }
}

// Computes what the joint adds to h dc: the derivative of `part.velocity` x `part.joint_velocity` by the velocity of
// the joint. `part.velocity` is still that of the parent.
void ArticulatedBody::find_drifts(const Part& part) {
  const Vector3d angular = part.velocity.head<3>();
  const Vector3d linear = part.velocity.tail<3>();
  for (int i = part.first_dof; i < part.first_dof + part.dofs; ++i) {
    const Vector3d axis_angular = axes_.col(i).head<3>();
    const Vector3d axis_linear = axes_.col(i).tail<3>();
    if (part.dofs < free_root) {
      drifts_.col(i).head<3>() = share_ * angular.cross(axis_angular);
      drifts_.col(i).tail<3>() = share_ * (angular.cross(axis_linear) + linear.cross(axis_angular));
    } else {
      // The reference point moves with the root: where its own acceleration is zero, the spatial acceleration is not.
      drifts_.col(i).head<3>().setZero();
      drifts_.col(i).tail<3>() = -share_ * (axis_angular.cross(Vector3d(part.joint_velocity.tail<3>())) +
                                            part.joint_velocity.head<3>().cross(axis_linear));
    }
  }
}

// Computes H of the segment alone. Its force is I a + v x I v; dv changes both factors of the second term.
void ArticulatedBody::find_force(const Segment& segment, const Pose& X_WS, const Matrix3d& R,
                                 const SpatialMatrix* added_mass, Part& part) const {
  const Vector3d arm = X_WS.position + R * segment.centre_S - part.point_W;
  const Matrix3d moment = cross_matrix(segment.mass * arm);
  Matrix6 inertia;
  inertia.topLeftCorner<3, 3>() = R * segment.inertia_S * R.transpose() +
                                  segment.mass * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose());
  inertia.topRightCorner<3, 3>() = moment;
  inertia.bottomLeftCorner<3, 3>() = -moment;
  inertia.bottomRightCorner<3, 3>() = segment.mass * Matrix3d::Identity();
  if (added_mass != nullptr) inertia += moved_inertia(*added_mass, X_WS, part.point_W);
  part.force.leftCols<6>() = inertia;
  part.force.rightCols<6>() = inertia;
  if (share_ == 0.0) return;

  const Vector6 momentum = share_ * (inertia * part.velocity);
  const Matrix3d angular = cross_matrix(share_ * part.velocity.head<3>());
  const Matrix3d linear = cross_matrix(share_ * part.velocity.tail<3>());
  part.force.topLeftCorner<3, 6>() += angular * inertia.topRows<3>() + linear * inertia.bottomRows<3>();
  part.force.block<3, 6>(3, 0) += angular * inertia.bottomRows<3>();
  part.force.block<3, 3>(0, 0) -= cross_matrix(momentum.head<3>());
  part.force.block<3, 3>(0, 3) -= cross_matrix(momentum.tail<3>());
  part.force.block<3, 3>(3, 0) -= cross_matrix(momentum.tail<3>());
}

template <int size>
Eigen::Matrix<double, size, size> ArticulatedBody::inverse_of(const Eigen::Matrix<double, size, size>& matrix) {
  if constexpr (size == 1) return matrix.cwiseInverse();
  system_.reset(size);
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) system_(row, column) = matrix(row, column);
  system_.factorise();
  Eigen::Matrix<double, size, size> inverse = Eigen::Matrix<double, size, size>::Identity();
  for (int column = 0; column < size; ++column) system_.solve(inverse.col(column).data());
  return inverse;
}

// Eliminates x of the joint above a segment and adds the force that is left to that on its parent.
template <int dofs>
void ArticulatedBody::eliminate(Part& part, const std::vector<double>& added_inertia) {
  const auto axes = axes_.middleCols<dofs>(part.first_dof);
  const auto drifts = drifts_.middleCols<dofs>(part.first_dof);
  auto forces = forces_.middleCols<dofs>(part.first_dof);
  auto shares = shares_.middleCols<dofs>(part.first_dof);
  forces.noalias() = part.force.leftCols<6>() * axes;
  forces.noalias() += part.force.rightCols<6>() * drifts;
  Eigen::Matrix<double, dofs, dofs> own = axes.transpose() * forces;
  for (int i = 0; i < dofs; ++i) own(i, i) += added_inertia[at(part.first_dof + i)];
  const Eigen::Matrix<double, dofs, dofs> inverse = inverse_of(own);
  inverses_.middleCols<dofs>(part.first_dof).template topRows<dofs>() = inverse;
  if (part.parent < 0) return;

  // The joint's velocity turns the parent's motion: dc = (parent's dc) - joint_velocity x (parent's dv) + ...
  const Matrix3d angular = cross_matrix(share_ * part.joint_velocity.head<3>());
  const Matrix3d linear = cross_matrix(share_ * part.joint_velocity.tail<3>());
  const auto by_drift = part.force.rightCols<6>();
  part.force.middleCols<3>(0) -= by_drift.leftCols<3>() * angular + by_drift.rightCols<3>() * linear;
  part.force.middleCols<3>(3) -= by_drift.rightCols<3>() * angular;

  const Eigen::Matrix<double, dofs, 12> on_joint = axes.transpose() * part.force;
  const Eigen::Matrix<double, dofs, 12> share = inverse * on_joint;
  shares = share.transpose();
  part.force.noalias() -= forces * share;

  // To the parent's point.
  const Matrix3d way = cross_matrix(part.way_W);
  part.force.middleCols<3>(0) -= part.force.middleCols<3>(3) * way;
  part.force.middleCols<3>(6) -= part.force.middleCols<3>(9) * way;
  part.force.topRows<3>() += way * part.force.bottomRows<3>();
  parts_[at(part.parent)].force += part.force;
}

void ArticulatedBody::solve(double* x) {
  Values values(x, axes_.cols());
  for (Change& change : changes_) change.force.setZero();
  for (std::size_t s = parts_.size(); s-- > 0;) {
    switch (parts_[s].dofs) {
      case 1: gather<1>(parts_[s], changes_[s].force, values); break;
      case 3: gather<3>(parts_[s], changes_[s].force, values); break;
      case 6: gather<6>(parts_[s], changes_[s].force, values); break;
      default: break;
    }
  }
  for (std::size_t s = 0; s < parts_.size(); ++s) {
    switch (parts_[s].dofs) {
      case 1: spread<1>(parts_[s], changes_[s], values); break;
      case 3: spread<3>(parts_[s], changes_[s], values); break;
      case 6: spread<6>(parts_[s], changes_[s], values); break;
      default: changes_[s].motion.setZero(); break;
    }
  }
}

// Replaces b of one joint by its x while the parent rests. Adds the force for that to the force on the parent.
template <int dofs>
void ArticulatedBody::gather(const Part& part, Vector6& force, Values& x) {
  using OfJoint = Eigen::Matrix<double, dofs, 1>;
  auto own = x.segment<dofs>(part.first_dof);
  const OfJoint left = own - axes_.middleCols<dofs>(part.first_dof).transpose() * force;
  own = inverses_.middleCols<dofs>(part.first_dof).template topRows<dofs>() * left;
  if (part.parent < 0) return;
  force += forces_.middleCols<dofs>(part.first_dof) * own;
  force.template head<3>() += part.way_W.cross(Vector3d(force.template tail<3>()));
  changes_[at(part.parent)].force += force;
}

// Completes x of one joint and computes the motion of its segment.
template <int dofs>
void ArticulatedBody::spread(const Part& part, Change& change, Values& x) const {
  auto own = x.segment<dofs>(part.first_dof);
  Motions& motion = change.motion;
  motion.setZero();
  if (part.parent >= 0) {
    motion = changes_[at(part.parent)].motion;
    motion.template segment<3>(3) += motion.template segment<3>(0).cross(part.way_W);
    motion.template segment<3>(9) += motion.template segment<3>(6).cross(part.way_W);
    own -= shares_.middleCols<dofs>(part.first_dof).transpose() * motion;
    const Vector3d angular = share_ * part.joint_velocity.head<3>();
    const Vector3d linear = share_ * part.joint_velocity.tail<3>();
    const Vector3d turned = motion.template segment<3>(0);
    const Vector3d moved = motion.template segment<3>(3);
    motion.template segment<3>(6) -= angular.cross(turned);
    motion.template segment<3>(9) -= angular.cross(moved) + linear.cross(turned);
  }
  motion.template head<6>() += axes_.middleCols<dofs>(part.first_dof) * own;
  motion.template tail<6>() += drifts_.middleCols<dofs>(part.first_dof) * own;
}

}  // namespace cohort::physics
