// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "idl/messages/ros_navigation_messages.hpp"

namespace cohort::ros2 {

/// Positions of joints over time, from a trajectory_msgs/msg/JointTrajectory. Positions are interpolated linearly
/// between two points, and from the last commanded position to the first point.
class Trajectory {
 public:
  struct Target {
    std::string joint;
    std::size_t offset = 0;  ///< index of its position among the commanded values
  };
  explicit Trajectory(std::vector<Target> targets) : targets_(std::move(targets)) {}

  /// Begins a trajectory, which replaces the former one. Throws std::invalid_argument that says what is wrong in the
  /// message.
  void begin(const messages::ros::JointTrajectory& message, std::span<const double> command);
  /// Ends the trajectory at the present positions.
  void end() { points_.clear(); }
  /// Sets the commanded positions of the joints for this time.
  void advance(std::chrono::nanoseconds time, std::span<double> command);

 private:
  struct Point {
    std::chrono::nanoseconds time{0};  // since the beginning
    std::vector<double> positions;     // in the order of `offsets_`
  };

  std::vector<Target> targets_;
  std::vector<std::size_t> offsets_;
  std::vector<Point> points_;  // the first has the initial positions; empty: no trajectory
  bool has_begun_ = false;
  std::chrono::nanoseconds begin_{0};
};

}  // namespace cohort::ros2
