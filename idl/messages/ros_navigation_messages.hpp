// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_geometry_messages.hpp"

/// Messages of ROS 2's nav_msgs and trajectory_msgs.
namespace cohort::messages::ros {

/// Pose of the frame `child_frame_id` in the frame of the header; the twist is expressed in the child frame.
struct Odometry {
  Header header{};
  std::string child_frame_id{};
  PoseWithCovariance pose{};
  TwistWithCovariance twist{};
  static constexpr const char* type = "nav_msgs/msg/Odometry";
  static constexpr auto fields =
      std::tuple(field("header", &Odometry::header), field("child_frame_id", &Odometry::child_frame_id),
                 field("pose", &Odometry::pose), field("twist", &Odometry::twist));
  bool operator==(const Odometry&) const = default;
};

/// A point of a trajectory: positions [rad] or [m], velocities [rad/s] or [m/s], accelerations [rad/s^2] or [m/s^2] and
/// efforts [N m] or [N]. Each list is in the order of the joint names, or empty.
struct JointTrajectoryPoint {
  std::vector<double> positions{};
  std::vector<double> velocities{};
  std::vector<double> accelerations{};
  std::vector<double> effort{};
  Duration time_from_start{};
  static constexpr const char* type = "trajectory_msgs/msg/JointTrajectoryPoint";
  static constexpr auto fields = std::tuple(
      field("positions", &JointTrajectoryPoint::positions), field("velocities", &JointTrajectoryPoint::velocities),
      field("accelerations", &JointTrajectoryPoint::accelerations), field("effort", &JointTrajectoryPoint::effort),
      field("time_from_start", &JointTrajectoryPoint::time_from_start));
  bool operator==(const JointTrajectoryPoint&) const = default;
};

struct JointTrajectory {
  Header header{};
  std::vector<std::string> joint_names{};
  std::vector<JointTrajectoryPoint> points{};
  static constexpr const char* type = "trajectory_msgs/msg/JointTrajectory";
  static constexpr auto fields =
      std::tuple(field("header", &JointTrajectory::header), field("joint_names", &JointTrajectory::joint_names),
                 field("points", &JointTrajectory::points));
  bool operator==(const JointTrajectory&) const = default;
};

}  // namespace cohort::messages::ros
