// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>

#include "idl/dds/ros2/discovery_info.hpp"
#include "idl/dds/ros2/ros_domain.hpp"
#include "idl/dds/ros2/ros_names.hpp"
#include "idl/messages/cdr.hpp"

namespace cohort::ros2 {
namespace {

TEST(Ros2Names, AreThoseOfDds) {
  EXPECT_EQ(dds_topic(TopicKind::message, "/robot_0/odom"), "rt/robot_0/odom");
  EXPECT_EQ(dds_topic(TopicKind::request, "/reset"), "rq/resetRequest");
  EXPECT_EQ(dds_topic(TopicKind::reply, "/reset"), "rr/resetReply");
  EXPECT_EQ(ros_topic("rt/robot_0/odom"), "/robot_0/odom");
  EXPECT_EQ(ros_topic("ros_discovery_info"), std::nullopt);
  EXPECT_EQ(dds_type("nav_msgs/msg/Odometry"), "nav_msgs::msg::dds_::Odometry_");
  EXPECT_EQ(ros_type("nav_msgs::msg::dds_::Odometry_"), "nav_msgs/msg/Odometry");
  EXPECT_EQ(ros_type("cohort_wire_Frame"), "cohort_wire_Frame");
}

TEST(Ros2Names, HaveNoCharactersThatRosForbids) {
  EXPECT_EQ(name_part("s-bot 7"), "s_bot_7");
  EXPECT_EQ(name_part("7"), "_7");
  EXPECT_EQ(name_part("9a"), "_9a");
  EXPECT_EQ(name_part("Az09"), "Az09");
  EXPECT_EQ(name_part(""), "_");
  EXPECT_EQ(absolute_name("explorers/s-bot/3"), "/explorers/s_bot/_3");
  EXPECT_EQ(absolute_name("//a//b/"), "/a/b");
  EXPECT_EQ(absolute_name("/"), "/");
}

Gid gid(std::uint8_t first) {
  Gid result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = static_cast<std::uint8_t>(first + i);
  return result;
}

std::string hex(std::span<const std::byte> bytes) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const std::byte each : bytes) {
    text += digits[std::to_integer<int>(each) >> 4];
    text += digits[std::to_integer<int>(each) & 15];
  }
  return text;
}

const ParticipantInfo cohort_node{gid(0x10), {{"/", "cohort", {gid(0x20)}, {gid(0x30), gid(0x40)}}}};

// A node `/cohort` with a reader and two writers, as rmw_dds_common writes it.
const std::string node_text =
    "01000000"
    "02000000"
    "2f000000"
    "07000000"
    "636f686f727400"
    "00";
const std::string p = "101112131415161718191a1b1c1d1e1f", r = "202122232425262728292a2b2c2d2e2f",
                  w = "303132333435363738393a3b3c3d3e3f", v = "404142434445464748494a4b4c4d4e4f";
const std::string fill(16, '0');

TEST(Ros2Discovery, AGidHas16BytesSinceIronAnd24Before) {
  EXPECT_EQ(hex(encode_discovery(cohort_node, GidFormat::since_iron)),
            "00010000" + p + node_text + "01000000" + r + "02000000" + w + v);
  EXPECT_EQ(hex(encode_discovery(cohort_node, GidFormat::humble)),
            "00010000" + p + fill + node_text + "01000000" + r + fill + "02000000" + w + fill + v + fill);
}

TEST(Ros2Discovery, ReadsItsOwnOutput) {
  for (const GidFormat format : {GidFormat::humble, GidFormat::since_iron}) {
    const std::vector<std::byte> bytes = encode_discovery(cohort_node, format);
    const ParticipantInfo read = decode_discovery(bytes);
    EXPECT_EQ(read.participant, cohort_node.participant);
    ASSERT_EQ(read.nodes.size(), 1U);
    EXPECT_EQ(read.nodes[0].name_space, "/");
    EXPECT_EQ(read.nodes[0].name, "cohort");
    EXPECT_EQ(read.nodes[0].readers, cohort_node.nodes[0].readers);
    EXPECT_EQ(read.nodes[0].writers, cohort_node.nodes[0].writers);
    // The bytes that fill a long Gid also say that a short one has no nodes.
    for (std::size_t size = 0; size < bytes.size(); ++size) try {
        EXPECT_TRUE(decode_discovery(std::span(bytes).first(size)).nodes.empty()) << size;
      } catch (const messages::CdrError&) {
      }
  }
}

// Environment variables for one test.
class Environment {
 public:
  explicit Environment(const std::vector<std::pair<std::string, std::string>>& variables) {
    for (const char* name : names) unsetenv(name);
    for (const auto& [name, value] : variables) setenv(name.c_str(), value.c_str(), 1);
  }
  ~Environment() {
    for (const char* name : names) unsetenv(name);
  }

 private:
  static constexpr std::array names = {"ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_LOCALHOST_ONLY",
                                       "ROS_STATIC_PEERS", "CYCLONEDDS_URI"};
};

TEST(Ros2Domain, IsReadFromTheEnvironment) {
  {
    const Environment none({});
    const RosDomain domain = RosDomain::from_environment();
    EXPECT_EQ(domain.number, 0U);
    EXPECT_EQ(domain.range, DiscoveryRange::subnet);
    EXPECT_TRUE(domain.static_peers.empty());
  }
  {
    const Environment some(
        {{"ROS_DOMAIN_ID", "232"}, {"ROS_LOCALHOST_ONLY", "1"}, {"ROS_STATIC_PEERS", "10.0.0.1;;b"}});
    const RosDomain domain = RosDomain::from_environment();
    EXPECT_EQ(domain.number, 232U);
    EXPECT_EQ(domain.range, DiscoveryRange::localhost);
    EXPECT_EQ(domain.static_peers, (std::vector<std::string>{"10.0.0.1", "b"}));
  }
  {
    const Environment newer({{"ROS_LOCALHOST_ONLY", "1"}, {"ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET"}});
    EXPECT_EQ(RosDomain::from_environment().range, DiscoveryRange::subnet);
  }
}

TEST(Ros2Domain, AnInvalidVariableIsNamed) {
  const auto expect_error = [](const std::string& name, const std::string& value, const std::string& text) {
    const Environment wrong({{name, value}});
    try {
      static_cast<void>(RosDomain::from_environment());
      ADD_FAILURE() << text;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), text);
    }
  };
  for (const std::string number : {"233", "-1", "4x", " 4", "99999999999"})
    expect_error("ROS_DOMAIN_ID", number,
                 "ROS_DOMAIN_ID: invalid value '" + number + "', expected a number from 0 to 232");
  expect_error(
      "ROS_AUTOMATIC_DISCOVERY_RANGE", "subnet",
      "ROS_AUTOMATIC_DISCOVERY_RANGE: invalid value 'subnet', expected SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT");
  expect_error("ROS_STATIC_PEERS", "a;<b>",
               "ROS_STATIC_PEERS: invalid peer '<b>', expected addresses or host names separated by ';'");
}

TEST(Ros2Domain, BecomesAConfigurationOfCyclone) {
  RosDomain domain;
  domain.number = 7;
  EXPECT_EQ(cyclone_configuration(domain),
            "<CycloneDDS><Domain Id=\"any\"><General></General><Discovery><ExternalDomainId>7</ExternalDomainId>"
            "</Discovery><Internal><GenerateKeyhash>true</GenerateKeyhash></Internal></Domain></CycloneDDS>");
  domain.range = DiscoveryRange::localhost;
  domain.static_peers = {"10.0.0.1"};
  domain.configuration = "file:///own.xml";
  EXPECT_EQ(cyclone_configuration(domain),
            "<CycloneDDS><Domain Id=\"any\"><General><AllowMulticast>false</AllowMulticast></General><Discovery>"
            "<ExternalDomainId>7</ExternalDomainId><ParticipantIndex>auto</ParticipantIndex>"
            "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers><Peer address=\"10.0.0.1\"/>"
            "<Peer address=\"localhost\"/></Peers></Discovery>"
            "<Internal><GenerateKeyhash>true</GenerateKeyhash></Internal></Domain></CycloneDDS>,file:///own.xml");
}

}  // namespace
}  // namespace cohort::ros2
