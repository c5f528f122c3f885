// SPDX-License-Identifier: Apache-2.0
#include "server/physics/dynamics/bias_forces.hpp"

namespace cohort::physics {

using Eigen::Vector3d;

void BiasForces::set_up(const BodyMotion& body, const std::vector<Spatial>& axes) {
  mechanism_ = &body.mechanism();
  axes_ = &axes;
  inertias_.resize(mechanism_->segments().size());
  motions_.resize(inertias_.size());
  added_masses_ = mechanism_->added_masses();
  for (std::size_t s = 0; s < added_masses_.size(); ++s)
    added_masses_[s] = moved_inertia(added_masses_[s], body.segment_pose(static_cast<int>(s)), body.reference());
  for (std::size_t s = 0; s < inertias_.size(); ++s) {
    const Segment& segment = mechanism_->segments()[s];
    const Pose& X_WS = body.segment_pose(static_cast<int>(s));
    const Eigen::Matrix3d R = X_WS.orientation.toRotationMatrix();
    const Vector3d arm = X_WS.position + R * segment.centre_S - body.reference();
    SpatialInertia& inertia = inertias_[s];
    inertia.mass = segment.mass;
    inertia.moment = segment.mass * arm;
    inertia.inertia = R * segment.inertia_S * R.transpose();
    inertia.inertia += segment.mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
}

void BiasForces::find(const double* velocities, const Vector3d& gravity, double* forces) {
  move_outwards(velocities, gravity);
  for (std::size_t s = motions_.size(); s-- > 0;) {
    const Segment& segment = mechanism_->segments()[s];
    const Spatial& force = motions_[s].force;
    for (int i = segment.first_dof; i < segment.first_dof + segment.dofs; ++i)
      forces[i] = (*axes_)[at(i)].angular.dot(force.angular) + (*axes_)[at(i)].linear.dot(force.linear);
    if (segment.parent < 0) continue;
    Spatial& of_parent = motions_[at(segment.parent)].force;
    of_parent.angular += force.angular;
    of_parent.linear += force.linear;
  }
}

// Computes velocities, accelerations at zero joint acceleration, and the force that each segment needs for them, from
// the root to the leaves. Gravity is modelled as an upward acceleration of the world.
void BiasForces::move_outwards(const double* velocities, const Vector3d& gravity) {
  const Spatial resting{Vector3d::Zero(), Vector3d::Zero()};
  const Spatial world{Vector3d::Zero(), -gravity};
  for (std::size_t s = 0; s < motions_.size(); ++s) {
    const Segment& segment = mechanism_->segments()[s];
    SegmentMotion& motion = motions_[s];
    motion.velocity = segment.parent < 0 ? resting : motions_[at(segment.parent)].velocity;
    motion.acceleration = segment.parent < 0 ? world : motions_[at(segment.parent)].acceleration;

    if (segment.motion == Motion::free) {
      motion.velocity = {{velocities[0], velocities[1], velocities[2]}, {velocities[3], velocities[4], velocities[5]}};
      // The reference point moves with the root: where its own acceleration is zero, the spatial acceleration is not.
      motion.acceleration.linear -= motion.velocity.angular.cross(motion.velocity.linear);
    } else {
      Spatial joint = resting;
      for (int dof = segment.first_dof; dof < segment.first_dof + segment.dofs; ++dof) {
        const Spatial& axis = (*axes_)[at(dof)];
        joint.angular += velocities[dof] * axis.angular;
        joint.linear += velocities[dof] * axis.linear;
      }
      motion.velocity.angular += joint.angular;
      motion.velocity.linear += joint.linear;
      motion.acceleration.angular += motion.velocity.angular.cross(joint.angular);
      motion.acceleration.linear +=
          motion.velocity.angular.cross(joint.linear) + motion.velocity.linear.cross(joint.angular);
    }
    take_force(motion, inertias_[s]);
    if (!added_masses_.empty()) add_force_of_fluid(motion, added_masses_[s], gravity);
  }
}

void BiasForces::take_force(SegmentMotion& motion, const SpatialInertia& segment) const {
  const Spatial& v = motion.velocity;
  const Spatial& a = motion.acceleration;
  const Vector3d angular_momentum = segment.inertia * v.angular + segment.moment.cross(v.linear);
  const Vector3d linear_momentum = segment.mass * v.linear - segment.moment.cross(v.angular);
  const Vector3d gyroscopic =
      mechanism_->turns_freely() ? Vector3d(Vector3d::Zero()) : Vector3d(v.angular.cross(angular_momentum));
  motion.force.angular =
      segment.inertia * a.angular + segment.moment.cross(a.linear) + gyroscopic + v.linear.cross(linear_momentum);
  motion.force.linear = segment.mass * a.linear - segment.moment.cross(a.angular) + v.angular.cross(linear_momentum);
}

void BiasForces::add_force_of_fluid(SegmentMotion& motion, const SpatialMatrix& added_mass, const Vector3d& gravity) {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const Spatial& v = motion.velocity;
  const Spatial& a = motion.acceleration;
  const Vector6 momentum = added_mass * (Vector6() << v.angular, v.linear).finished();
  const Vector6 force = added_mass * (Vector6() << a.angular, a.linear + gravity).finished();
  motion.force.angular += force.head<3>() + v.angular.cross(momentum.head<3>()) + v.linear.cross(momentum.tail<3>());
  motion.force.linear += force.tail<3>() + v.angular.cross(momentum.tail<3>());
}

}  // namespace cohort::physics
