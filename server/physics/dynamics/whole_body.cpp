// SPDX-License-Identifier: Apache-2.0
#include "server/physics/dynamics/whole_body.hpp"

#include <vector>

#include "server/physics/dynamics/body_motion.hpp"

namespace cohort::physics {

using Eigen::Vector3d;

WholeBody::WholeBody(const BodyMotion& body) {
  const std::vector<Segment>& segments = body.mechanism().segments();
  struct SegmentMotion {  // relative to the root, at the segment's origin
    Vector3d angular_W = Vector3d::Zero();
    Vector3d linear_W = Vector3d::Zero();
    Vector3d centre_W = Vector3d::Zero();
    Vector3d centre_velocity_W = Vector3d::Zero();
  };
  std::vector<SegmentMotion> motions(segments.size());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Segment& segment = segments[s];
    const Pose& X_WS = body.segment_poses()[s];
    SegmentMotion& motion = motions[s];
    if (segment.parent >= 0) {
      const auto parent = static_cast<std::size_t>(segment.parent);
      motion.angular_W = motions[parent].angular_W;
      motion.linear_W =
          motions[parent].linear_W + motion.angular_W.cross(X_WS.position - body.segment_poses()[parent].position);
    }
    if (segment.motion != Motion::free) {
      const Spatial joint = motion_at_joint(segment, X_WS.orientation, body.velocities() + segment.first_dof);
      motion.angular_W += joint.angular;
      motion.linear_W += joint.linear;
    }
    motion.centre_W = X_WS * segment.centre_S;
    motion.centre_velocity_W = motion.linear_W + motion.angular_W.cross(motion.centre_W - X_WS.position);
    mass += segment.mass;
    centre_W += segment.mass * motion.centre_W;
    joints_momentum_W += segment.mass * motion.centre_velocity_W;
  }
  centre_W /= mass;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const SegmentMotion& motion = motions[s];
    const Eigen::Matrix3d R = body.segment_poses()[s].orientation.toRotationMatrix();
    const Eigen::Matrix3d own_W = R * segments[s].inertia_S * R.transpose();
    const Vector3d arm_W = motion.centre_W - centre_W;
    inertia_W +=
        own_W + segments[s].mass * (arm_W.squaredNorm() * Eigen::Matrix3d::Identity() - arm_W * arm_W.transpose());
    joints_angular_momentum_W += own_W * motion.angular_W + segments[s].mass * arm_W.cross(motion.centre_velocity_W);
  }
}

}  // namespace cohort::physics
