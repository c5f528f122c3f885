// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/ros2/ros_domain.hpp"

#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace cohort::ros2 {
namespace {

// The last domain whose ports exist.
constexpr std::uint32_t last_domain = 232;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::uint32_t domain_number() {
  const std::string text = variable("ROS_DOMAIN_ID");
  if (text.empty()) return 0;
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number > last_domain)
    throw std::invalid_argument("ROS_DOMAIN_ID: invalid value '" + text + "', expected a number from 0 to " +
                                std::to_string(last_domain));
  return number;
}

DiscoveryRange discovery_range() {
  const std::string text = variable("ROS_AUTOMATIC_DISCOVERY_RANGE");
  // The older variable applies if the newer one is not set.
  if (text.empty() || text == "SYSTEM_DEFAULT")
    return variable("ROS_LOCALHOST_ONLY") == "1" ? DiscoveryRange::localhost : DiscoveryRange::subnet;
  if (text == "SUBNET") return DiscoveryRange::subnet;
  if (text == "LOCALHOST") return DiscoveryRange::localhost;
  if (text == "OFF") return DiscoveryRange::off;
  throw std::invalid_argument("ROS_AUTOMATIC_DISCOVERY_RANGE: invalid value '" + text +
                              "', expected SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT");
}

std::vector<std::string> peers_of_environment() {
  std::vector<std::string> peers;
  const std::string text = variable("ROS_STATIC_PEERS");
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::string_view peer = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(rest.size(), peer.size() + 1));
    if (peer.empty()) continue;
    if (peer.find_first_of("<>\"'& ") != std::string_view::npos)
      throw std::invalid_argument("ROS_STATIC_PEERS: invalid peer '" + std::string(peer) +
                                  "', expected addresses or host names separated by ';'");
    peers.emplace_back(peer);
  }
  return peers;
}

}  // namespace

RosDomain RosDomain::from_environment() {
  return {domain_number(), discovery_range(), peers_of_environment(), variable("CYCLONEDDS_URI")};
}

std::string cyclone_configuration(const RosDomain& domain) {
  std::string general;
  std::string discovery = "<ExternalDomainId>" + std::to_string(domain.number) + "</ExternalDomainId>";
  std::string peers;
  for (const std::string& peer : domain.static_peers) peers += "<Peer address=\"" + peer + "\"/>";
  const bool is_local = domain.range == DiscoveryRange::localhost;
  if (is_local) peers += "<Peer address=\"localhost\"/>";
  if (domain.range != DiscoveryRange::subnet) general = "<AllowMulticast>false</AllowMulticast>";
  // Without multicast, peers try the ports of the first participants on a machine.
  if (!peers.empty())
    discovery +=
        "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers>" +
        peers + "</Peers>";
  // Without hashes of keys, Fast DDS does not notice that an endpoint has gone.
  std::string xml = "<CycloneDDS><Domain Id=\"any\"><General>" + general + "</General><Discovery>" + discovery +
                    "</Discovery><Internal><GenerateKeyhash>true</GenerateKeyhash></Internal></Domain></CycloneDDS>";
  if (!domain.configuration.empty()) xml += "," + domain.configuration;
  return xml;
}

}  // namespace cohort::ros2
