// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/robots/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "idl/messages/ros_messages.hpp"
#include "idl/text/printable.hpp"

namespace cohort::ros2 {

void Trajectory::begin(const messages::ros::JointTrajectory& message, std::span<const double> command) {
  std::vector<std::size_t> offsets;
  for (const std::string& joint : message.joint_names) {
    const auto target = std::ranges::find(targets_, joint, &Target::joint);
    if (target == targets_.end()) {
      std::string known;
      for (const Target& each : targets_) known += (known.empty() ? "" : ", ") + each.joint;
      throw std::invalid_argument("it has no position-controlled joint '" + printable(joint) + "'; there are " + known);
    }
    offsets.push_back(target->offset);
  }
  std::vector<Point> points(1);
  for (const std::size_t offset : offsets) points.front().positions.push_back(command[offset]);
  for (const messages::ros::JointTrajectoryPoint& point : message.points) {
    const auto& [sec, nanosec] = point.time_from_start;
    const std::chrono::nanoseconds time = std::chrono::seconds(sec) + std::chrono::nanoseconds(nanosec);
    if (point.positions.size() != offsets.size())
      throw std::invalid_argument("a point has " + std::to_string(point.positions.size()) + " positions for " +
                                  std::to_string(offsets.size()) + " joints");
    if (!std::ranges::all_of(point.positions, [](double each) { return std::isfinite(each); }))
      throw std::invalid_argument("a position is not finite");
    if (time < points.back().time)
      throw std::invalid_argument("the times of its points must be non-negative and in ascending order");
    points.push_back({time, point.positions});
  }
  has_begun_ = message.header.stamp.sec != 0 || message.header.stamp.nanosec != 0;
  begin_ = messages::ros::nanoseconds(message.header.stamp);
  offsets_ = std::move(offsets);
  points_ = std::move(points);
  if (points_.size() == 1) points_.clear();
}

void Trajectory::advance(std::chrono::nanoseconds time, std::span<double> command) {
  if (points_.empty()) return;
  if (!has_begun_) begin_ = time;
  has_begun_ = true;
  const std::chrono::nanoseconds since = time - begin_;
  const auto next = std::ranges::upper_bound(points_, since, {}, &Point::time);
  if (next == points_.begin()) return;  // is yet to begin
  const Point& from = *(next - 1);
  const Point& to = next == points_.end() ? from : *next;
  const std::chrono::duration<double> length = to.time - from.time;
  const double share = length.count() > 0.0 ? std::chrono::duration<double>(since - from.time) / length : 0.0;
  for (std::size_t i = 0; i < offsets_.size(); ++i)
    command[offsets_[i]] = from.positions[i] + share * (to.positions[i] - from.positions[i]);
  if (next == points_.end()) points_.clear();  // it is done, and its end stays commanded
}

}  // namespace cohort::ros2
