// SPDX-License-Identifier: Apache-2.0
#include "server/physics/dynamics/joint_axes.hpp"

namespace cohort::physics {

void find_joint_axes(const BodyMotion& body, std::vector<Spatial>& axes) {
  const Eigen::Vector3d reference = body.reference();
  const std::vector<Segment>& segments = body.mechanism().segments();
  axes.resize(static_cast<std::size_t>(body.mechanism().dof_count()));
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Segment& segment = segments[s];
    const Pose& X_WS = body.segment_pose(static_cast<int>(s));
    const Eigen::Matrix3d R = X_WS.orientation.toRotationMatrix();
    const Eigen::Vector3d arm_W = reference - (segment.motion == Motion::free ? reference : X_WS.position);
    for (int i = 0; i < segment.dofs; ++i) {
      Spatial& axis = axes[static_cast<std::size_t>(segment.first_dof + i)];
      axis = axis_of_joint(segment, R, i);
      axis.linear += axis.angular.cross(arm_W);
    }
  }
}

}  // namespace cohort::physics
