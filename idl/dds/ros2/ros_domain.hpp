// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cohort::ros2 {

/// Where participants discover each other.
enum class DiscoveryRange {
  subnet,     ///< multicast: everything within reach
  localhost,  ///< only this machine
  off,        ///< only the static peers
};

/// A ROS 2 domain, as defined by its environment variables.
struct RosDomain {
  std::uint32_t number = 0;
  DiscoveryRange range = DiscoveryRange::subnet;
  std::vector<std::string> static_peers{};  ///< addresses or host names
  std::string configuration{};              ///< XML or files of Cyclone DDS from the user, applied after ours

  /// Reads ROS_DOMAIN_ID, ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_LOCALHOST_ONLY, ROS_STATIC_PEERS and CYCLONEDDS_URI, with
  /// their meaning in ROS 2's rmw layer. Throws std::invalid_argument with the name of the variable.
  static RosDomain from_environment();
};

/// Returns the configuration of Cyclone DDS for a domain.
std::string cyclone_configuration(const RosDomain& domain);

}  // namespace cohort::ros2
