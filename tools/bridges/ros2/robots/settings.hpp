#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/description/ros2.hpp"

namespace cohort::ros2 {

/// How one robot is seen from ROS: what its experiment says, with the robot's own namespace.
using RobotSettings = description::Ros2Settings;

/// Returns the name of a topic for ROS; nothing if it is left out. `topic` is ours, such as `scan`.
std::optional<std::string> name_of_topic(const RobotSettings& settings, std::string_view topic);

/// Returns the settings of robots of one kind for a robot that was added during the run. Its topics are in the
/// namespace of its own name, also those with absolute names.
RobotSettings in_own_namespace(RobotSettings settings);

/// Returns how often a topic is told at the most [Hz]; 0: as often as there is something new.
double rate_of_topic(const RobotSettings& settings, std::string_view topic);

}  // namespace cohort::ros2
