// SPDX-License-Identifier: Apache-2.0
#include "server/physics/islands/force_record.hpp"

namespace cohort::physics {

using Eigen::Vector3d;

ForceRecord::ForceRecord(const Mechanism& mechanism, std::uint32_t first_solid,
                         std::vector<std::size_t> links_of_solids)
    : mechanism_(mechanism),
      first_solid_(first_solid),
      links_of_solids_(std::move(links_of_solids)),
      motion_(mechanism.model()) {
  const description::Model& model = mechanism.model();
  for (std::size_t link = 0; link < model.links.size(); ++link) parents_.push_back(link);
  for (const description::Joint& joint : model.joints)
    if (joint.parent != description::Joint::world) parents_[joint.child] = joint.parent;
}

void ForceRecord::begin(const BodyMotion& body) {
  motion_.before(body);
  const std::size_t segments = mechanism_.segments().size();
  X_WS_.resize(segments);
  for (std::size_t s = 0; s < segments; ++s) X_WS_[s] = body.segment_pose(static_cast<int>(s));
  velocities_.assign(body.velocities(), body.velocities() + mechanism_.dof_count());
  reference_W_ = body.reference();
}

void ForceRecord::finish(const BodyMotion& body, const double* velocities, bool in_the_middle, const Vector3d& gravity,
                         double step) {
  step_ = step;
  motion_.after(body);
  needed_.assign(parents_.size(), {Vector3d::Zero(), Vector3d::Zero()});
  std::vector<double> accelerations(velocities_.size());
  for (std::size_t i = 0; i < velocities_.size(); ++i) accelerations[i] = (velocities[i] - velocities_[i]) / step;
  if (!in_the_middle) return add_needed(1.0, velocities_, accelerations, gravity);

  // Bias forces are quadratic in the velocities. The linearly implicit midpoint is the bias force at the middle
  // velocities without the term of second order in the change.
  std::vector<double> middle(velocities_.size());
  std::vector<double> half_the_change(velocities_.size());
  for (std::size_t i = 0; i < velocities_.size(); ++i) {
    half_the_change[i] = 0.5 * (velocities[i] - velocities_[i]);
    middle[i] = velocities_[i] + half_the_change[i];
  }
  add_needed(1.0, middle, accelerations, gravity);
  add_needed(-1.0, half_the_change, std::vector<double>(velocities_.size(), 0.0), Vector3d::Zero());
}

// Adds the force that each link needs for these velocities and accelerations.
void ForceRecord::add_needed(double factor, const std::vector<double>& velocities,
                             const std::vector<double>& accelerations, const Vector3d& gravity) {
  find_accelerations(velocities, accelerations);
  for (std::size_t link = 0; link < parents_.size(); ++link) {
    const description::Inertial& inertial = mechanism_.model().links[link].inertial;
    const auto segment = static_cast<std::size_t>(mechanism_.link(link).segment);
    const SegmentMotion& motion = segments_[segment];
    const Vector3d& w = motion.angular_velocity_W;
    const Pose X_WI = motion_.pose_before(link) * inertial.X_LI;
    const Vector3d arm_W = X_WI.position - X_WS_[segment].position;
    const Vector3d acceleration_W =
        motion.acceleration_W + motion.angular_acceleration_W.cross(arm_W) + w.cross(w.cross(arm_W));
    const Eigen::Matrix3d R = X_WI.orientation.toRotationMatrix();
    const Eigen::Matrix3d inertia_W = R * inertial.inertia * R.transpose();
    const Vector3d force_W = inertial.mass * (acceleration_W - gravity);
    needed_[link].force_W += factor * force_W;
    needed_[link].torque_W += factor * (inertia_W * motion.angular_acceleration_W + w.cross(inertia_W * w) +
                                        (X_WI.position - reference_W_).cross(force_W));
    if (inertial.added_mass) add_needed_in_fluid(factor, link, *inertial.added_mass);
  }
}

// The force is M a + v x M v (Featherstone, "Rigid body dynamics algorithms", 2008, section 2.14) about the link's
// origin, where a is the spatial acceleration.
void ForceRecord::add_needed_in_fluid(double factor, std::size_t link, const SpatialMatrix& added_mass) {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const auto segment = static_cast<std::size_t>(mechanism_.link(link).segment);
  const SegmentMotion& motion = segments_[segment];
  const Pose& X_WL = motion_.pose_before(link);
  const Vector3d arm_W = X_WL.position - X_WS_[segment].position;
  const Vector3d& w = motion.angular_velocity_W;
  const Vector3d& alpha = motion.angular_acceleration_W;
  const Vector3d v = motion.velocity_W + w.cross(arm_W);
  const Vector3d a = motion.acceleration_W + alpha.cross(arm_W) + w.cross(w.cross(arm_W)) - w.cross(v);
  const SpatialMatrix M = moved_inertia(added_mass, X_WL, X_WL.position);
  const Vector6 momentum = M * (Vector6() << w, v).finished();
  const Vector6 force = M * (Vector6() << alpha, a).finished();
  const Vector3d force_W = force.tail<3>() + w.cross(momentum.tail<3>());
  const Vector3d torque_W = force.head<3>() + w.cross(momentum.head<3>()) + v.cross(momentum.tail<3>());
  needed_[link].force_W += factor * force_W;
  needed_[link].torque_W += factor * (torque_W + (X_WL.position - reference_W_).cross(force_W));
}

// Computes accelerations of the segments' origins from the root to the leaves (Craig, "Introduction to robotics",
// section 6.5).
void ForceRecord::find_accelerations(const std::vector<double>& velocities, const std::vector<double>& accelerations) {
  segments_.resize(X_WS_.size());
  const Vector3d zero = Vector3d::Zero();
  for (std::size_t s = 0; s < X_WS_.size(); ++s) {
    const Segment& segment = mechanism_.segments()[s];
    const double* v = velocities.data() + segment.first_dof;
    const double* a = accelerations.data() + segment.first_dof;
    SegmentMotion& motion = segments_[s];
    motion = {zero, zero, zero, zero};
    if (segment.parent >= 0) {
      const auto parent = static_cast<std::size_t>(segment.parent);
      motion = segments_[parent];
      const Vector3d arm_W = X_WS_[s].position - X_WS_[parent].position;
      const Vector3d& w = motion.angular_velocity_W;
      motion.velocity_W += w.cross(arm_W);
      motion.acceleration_W += motion.angular_acceleration_W.cross(arm_W) + w.cross(w.cross(arm_W));
    }
    const Vector3d w = motion.angular_velocity_W;  // the parent's
    const Spatial joint = motion_at_joint(segment, X_WS_[s].orientation, v);
    const Spatial change = motion_at_joint(segment, X_WS_[s].orientation, a);
    if (segment.motion == Motion::free) {
      const Vector3d arm_W = X_WS_[s].position - reference_W_;
      motion.angular_velocity_W = joint.angular;
      motion.angular_acceleration_W = change.angular;
      motion.velocity_W = joint.linear + joint.angular.cross(arm_W);
      motion.acceleration_W =
          change.linear + change.angular.cross(arm_W) + joint.angular.cross(joint.angular.cross(arm_W));
      continue;
    }
    motion.angular_velocity_W += joint.angular;
    motion.angular_acceleration_W += change.angular + w.cross(joint.angular);
    motion.velocity_W += joint.linear;
    motion.acceleration_W += change.linear + 2.0 * w.cross(joint.linear);
  }
}

void ForceRecord::add_outside(std::size_t link, const Vector3d& point_W, const Vector3d& impulse_W,
                              const Vector3d& angular_impulse_W) {
  if (!motion_.is_whole()) return;
  const Vector3d torque_W = angular_impulse_W + (point_W - reference_W_).cross(impulse_W);
  needed_[link].force_W -= impulse_W / step_;
  needed_[link].torque_W -= torque_W / step_;
}

// The wrench is constant in the axes of the link that it acts on. In a vehicle's axes, the weight of a wheel must
// not turn with the wheel: at 100 rad/s, that would be a radian in a step of 10 ms.
Wrench ForceRecord::joint_wrench(std::size_t index) const {
  const description::Joint& joint = mechanism_.model().joints[index];
  Wrench on_child = wrench_before(joint);
  if (!motion_.is_whole()) return on_child;
  const Eigen::Quaterniond turn = motion_.turn(joint.child);
  return {turn * on_child.force_W, turn * on_child.torque_W};
}

Wrench ForceRecord::joint_wrench_on_parent(std::size_t index) const {
  const description::Joint& joint = mechanism_.model().joints[index];
  const Wrench on_child = wrench_before(joint);
  if (!motion_.is_whole() || joint.parent == description::Joint::world) return {-on_child.force_W, -on_child.torque_W};
  const Eigen::Quaterniond turn = motion_.turn(joint.parent);
  return {turn * -on_child.force_W, turn * -on_child.torque_W};
}

// Returns the wrench on the joint's child at the beginning of the step.
Wrench ForceRecord::wrench_before(const description::Joint& joint) const {
  Wrench sum{Vector3d::Zero(), Vector3d::Zero()};
  if (!motion_.is_whole()) return sum;
  // Select the child and everything it carries: links come after their parents.
  std::vector<char> is_below(parents_.size(), 0);
  is_below[joint.child] = 1;
  for (std::size_t link = joint.child; link < parents_.size(); ++link) {
    if (link != joint.child) is_below[link] = is_below[parents_[link]] != 0 && parents_[link] != link ? 1 : 0;
    if (is_below[link] == 0) continue;
    sum.force_W += needed_[link].force_W;
    sum.torque_W += needed_[link].torque_W;
  }
  const Vector3d origin_W = motion_.pose_before(joint.child) * joint.X_LJ.position;
  sum.torque_W -= (origin_W - reference_W_).cross(sum.force_W);
  return sum;
}

}  // namespace cohort::physics
