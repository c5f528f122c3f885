// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/description/ros2.hpp"

namespace cohort::ros2 {

/// The ROS settings of one robot: those of its experiment, with the robot's own namespace.
using RobotSettings = description::Ros2Settings;

/// Returns the ROS name of a topic; nullopt if the topic is not published. `topic` is the name in Cohort, such as
/// `scan`.
std::optional<std::string> name_of_topic(const RobotSettings& settings, std::string_view topic);

/// Returns the settings of robots of one kind, adapted to a robot that was added during the run. All its topics are in
/// a namespace with the robot's name, even those with absolute names.
RobotSettings in_own_namespace(RobotSettings settings);

/// Returns the maximum rate of a topic [Hz]; 0: one message for each measurement.
double rate_of_topic(const RobotSettings& settings, std::string_view topic);

}  // namespace cohort::ros2
