// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Conversion of ROS 2 names to DDS names (design.ros2.org, "Topic and Service name mapping to DDS").
namespace cohort::ros2 {

/// Content of a DDS topic of ROS.
enum class TopicKind { message, request, reply };

/// Returns the DDS topic of a ROS topic or service, such as `rt/swarm/robot_0/odom`. `name` is absolute.
std::string dds_topic(TopicKind kind, std::string_view name);
/// Returns the absolute ROS name of a DDS topic; nothing if it does not belong to ROS.
std::optional<std::string> ros_topic(std::string_view dds_topic);

/// Returns the DDS name of a type, such as `nav_msgs::msg::dds_::Odometry_` for `nav_msgs/msg/Odometry`. Requests and
/// replies of a service are named like messages: `std_srvs/srv/Trigger_Request`.
std::string dds_type(std::string_view type);
/// Returns `nav_msgs/msg/Odometry` for the result of `dds_type`; other names unchanged.
std::string ros_type(std::string_view dds_type);

/// Returns a part of a ROS name: characters other than letters, digits and `_` are replaced by `_`, and the first one
/// is not a digit.
std::string name_part(std::string_view text);
/// Returns an absolute ROS name: `name` with each part converted by `name_part`, joined by `/`.
std::string absolute_name(std::string_view name);

}  // namespace cohort::ros2
