// SPDX-License-Identifier: Apache-2.0
#include "server/recording/ros_channels.hpp"

namespace cohort::recording {

StringMap ros_channel_metadata(bool is_latched) {
  // The QoS profile in numbers, as rosbag2 reads it in files without a version: unknown history, reliable, transient
  // local or volatile, automatic liveliness, and no deadlines.
  const std::string endless = "\n    sec: 9223372036\n    nsec: 854775807\n";
  return {{"offered_qos_profiles",
           "- history: 3\n  depth: 0\n  reliability: 1\n  durability: " + std::string(is_latched ? "1" : "2") +
               "\n  deadline:" + endless + "  lifespan:" + endless +
               "  liveliness: 1\n  liveliness_lease_duration:" + endless + "  avoid_ros_namespace_conventions: false"}};
}

}  // namespace cohort::recording
