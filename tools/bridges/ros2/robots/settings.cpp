// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/robots/settings.hpp"

#include "idl/dds/ros2/ros_names.hpp"
#include "server/description/select_robots.hpp"

namespace cohort::ros2 {

std::optional<std::string> name_of_topic(const RobotSettings& settings, std::string_view topic) {
  std::string name(topic);
  bool is_published = true;
  for (const description::Ros2Topic& each : settings.topics) {
    if (!description::matches(topic, each.topic)) continue;
    is_published = each.is_published;
    if (!each.name.empty()) name = each.name;
  }
  if (!is_published) return std::nullopt;
  return absolute_name(name.starts_with('/') ? name : settings.name_space + "/" + name);
}

RobotSettings in_own_namespace(RobotSettings settings) {
  settings.name_space.clear();
  for (description::Ros2Topic& topic : settings.topics) topic.name.erase(0, topic.name.find_first_not_of('/'));
  return settings;
}

double rate_of_topic(const RobotSettings& settings, std::string_view topic) {
  double rate = 0.0;
  for (const description::Ros2Topic& each : settings.topics)
    if (description::matches(topic, each.topic)) rate = each.rate.value_or(rate);
  return rate;
}

}  // namespace cohort::ros2
