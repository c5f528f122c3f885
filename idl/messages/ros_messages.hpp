// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "idl/messages/ros_geometry_messages.hpp"

/// ROS 2 messages of small packages, with the names, types and order of fields of the release Jazzy. SI units unless
/// stated otherwise; x forward, y left, z up.
namespace cohort::messages::ros {

struct Clock {
  Time clock{};
  static constexpr const char* type = "rosgraph_msgs/msg/Clock";
  static constexpr auto fields = std::tuple(field("clock", &Clock::clock));
  bool operator==(const Clock&) const = default;
};

struct TFMessage {
  std::vector<TransformStamped> transforms{};
  static constexpr const char* type = "tf2_msgs/msg/TFMessage";
  static constexpr auto fields = std::tuple(field("transforms", &TFMessage::transforms));
  bool operator==(const TFMessage&) const = default;
};

/// Converts a time to seconds and nanoseconds. Times after 2038 are clamped to the last time that the message can
/// represent.
Time time(std::chrono::nanoseconds since_epoch);
std::chrono::nanoseconds nanoseconds(const Time& time);

}  // namespace cohort::messages::ros
