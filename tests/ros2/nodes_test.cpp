// SPDX-License-Identifier: Apache-2.0
#include "tests/ros2/nodes.hpp"

#include <gtest/gtest.h>

namespace cohort::test {
namespace {

TEST(Ros2Nodes, NodesOfBothDistributionsCommunicate) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const OwnNetwork network;
  std::vector<std::unique_ptr<Process>> talkers, listeners;
  for (const Ros2Distribution& distribution : ros2_distributions()) {
    talkers.push_back(network.start_node(distribution, "talker_and_listener.py", {"talk", distribution.name}));
    listeners.push_back(network.start_node(distribution, "talker_and_listener.py", {"listen"}));
  }
  for (const auto& listener : listeners)
    for (const Ros2Distribution& distribution : ros2_distributions())
      EXPECT_TRUE(listener->wait_for_output("heard " + distribution.name)) << listener->output();
}

TEST(Ros2Nodes, NetworksAreIsolated) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const OwnNetwork first, second;
  const Ros2Distribution& any = ros2_distributions().front();
  const auto talker = first.start_node(any, "talker_and_listener.py", {"talk", "first"});
  const auto other = second.start_node(any, "talker_and_listener.py", {"talk", "second"});
  const auto listener = first.start_node(any, "talker_and_listener.py", {"listen"});
  EXPECT_TRUE(listener->wait_for_output("heard first\nheard first\nheard first\n")) << listener->output();
}

// The packages of tests/ros2/interfaces, the second of which uses the first.
TEST(Ros2Nodes, NodesUseInterfacesThatAreBuiltFromTheirTexts) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const OwnNetwork network;
  std::vector<std::unique_ptr<Process>> servers, callers;
  for (const Ros2Distribution& distribution : ros2_distributions()) {
    const Process::Environment environment = {
        {"PYTHONPATH", build_interfaces(distribution, COHORT_SOURCE_DIR "/tests/ros2/interfaces", "tested",
                                        {"tf2_msgs", "echo_interfaces"})}};
    servers.push_back(network.start_node(distribution, "echo.py", {"serve", distribution.name}, environment));
    for (const Ros2Distribution& server : ros2_distributions())
      callers.push_back(network.start_node(distribution, "echo.py", {"call", server.name}, environment));
  }
  for (const auto& caller : callers) {
    EXPECT_EQ(caller->wait_for_exit(), 0);
    EXPECT_EQ(caller->output(), "odom base 1.5 code 2 ['ä', '']\n");
  }
}

}  // namespace
}  // namespace cohort::test
