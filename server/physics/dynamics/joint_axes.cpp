#include "server/physics/dynamics/joint_axes.hpp"

namespace cohort::physics {

void find_joint_axes(const BodyMotion& body, std::vector<Spatial>& axes) {
  const Eigen::Vector3d reference = body.reference();
  const std::vector<Segment>& segments = body.mechanism().segments();
  axes.resize(static_cast<std::size_t>(body.mechanism().dof_count()));
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Segment& segment = segments[s];
    if (segment.motion == Motion::free) {
      for (int i = 0; i < 3; ++i) {
        axes[static_cast<std::size_t>(i)] = {Eigen::Vector3d::Unit(i), Eigen::Vector3d::Zero()};
        axes[static_cast<std::size_t>(3 + i)] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Unit(i)};
      }
      continue;
    }
    const Pose& X_WS = body.segment_pose(static_cast<int>(s));
    const Eigen::Matrix3d R = X_WS.orientation.toRotationMatrix();
    for (int i = 0; i < segment.dofs; ++i) {
      const Eigen::Vector3d direction =
          segment.motion == Motion::ball ? Eigen::Vector3d(R.col(i)) : Eigen::Vector3d(R * segment.axis_S);
      Spatial& axis = axes[static_cast<std::size_t>(segment.first_dof + i)];
      if (segment.motion == Motion::prismatic) {
        axis = {Eigen::Vector3d::Zero(), direction};
      } else {
        axis = {direction, direction.cross(reference - X_WS.position)};
      }
    }
  }
}

}  // namespace cohort::physics
