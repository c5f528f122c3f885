// SPDX-License-Identifier: Apache-2.0
#include <thread>

#include "tests/ros2/bridged_nodes.hpp"

namespace cohort::test {
namespace {

using Nodes = std::vector<std::unique_ptr<Process>>;

// A TurtleBot3 whose node answers every scan of its lidar.
BridgedNodes::Options scanning(const std::string& threads = "1") {
  BridgedNodes::Options options{.experiment = "turtlebot3", .seconds = "3", .threads = threads};
  options.bridge = {"--sync", "command"};
  return options;
}

std::string hash_of_scanning(const Ros2Distribution& distribution, const std::string& threads,
                             const std::string& command = "TwistStamped", const std::string& speed = "0.1") {
  BridgedNodes run(scanning(threads));
  run.start();
  const auto node = run.start_node(distribution, "commander.py", {"/", "scan", command, speed});
  return run.hash();
}

// Four robots, each with a node of its own that answers its odometry.
std::string hash_of_four(const std::string& threads, const std::vector<Ros2Distribution>& distributions,
                         const std::string& speed_of_last = "0.1") {
  BridgedNodes::Options options{.experiment = "arduino", .seconds = "2", .threads = threads};
  options.bridge = {"--sync", "command"};
  BridgedNodes run(options);
  run.start();
  Nodes nodes;
  for (int robot = 0; robot < 4; ++robot)
    nodes.push_back(
        run.start_node(distributions[robot % distributions.size()], "commander.py",
                       {"/robot_" + std::to_string(robot), "odom", "Twist", robot == 3 ? speed_of_last : "0.1"}));
  return run.hash();
}

TEST(Ros2Lockstep, ANodeDrivesARobotToTheSameStateAgainAndWithAnyThreadsAndDistribution) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string hash = hash_of_scanning(jazzy(), "1");
  EXPECT_EQ(hash_of_scanning(jazzy(), "1"), hash);
  EXPECT_EQ(hash_of_scanning(jazzy(), "2"), hash);
  EXPECT_EQ(hash_of_scanning(kilted(), "1"), hash);
  EXPECT_EQ(hash_of_scanning(jazzy(), "1", "Twist"), hash) << "a stamp changes nothing";
  EXPECT_NE(hash_of_scanning(jazzy(), "1", "TwistStamped", "0.11"), hash) << "the node does not drive it";
}

TEST(Ros2Lockstep, SeparateNodesDriveFourRobotsToTheSameState) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string hash = hash_of_four("1", {jazzy()});
  EXPECT_EQ(hash_of_four("2", {jazzy()}), hash);
  EXPECT_EQ(hash_of_four("2", {kilted(), jazzy()}), hash) << "nodes of two distributions";
  EXPECT_NE(hash_of_four("1", {jazzy()}, "0.11"), hash) << "the last node does not drive its robot";
}

TEST(Ros2Lockstep, BusyCoresChangeNothing) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string hash = hash_of_four("1", {jazzy()});
  Nodes busy;
  for (unsigned core = 0; core < std::thread::hardware_concurrency(); ++core)
    busy.push_back(std::make_unique<Process>(std::vector<std::string>{"/bin/sh", "-c", "while :; do :; done"}));
  EXPECT_EQ(hash_of_four("1", {jazzy()}), hash);
}

TEST(Ros2Lockstep, ANodeThatStartsFirstOrLastAnswersEveryFrame) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string hash = hash_of_scanning(jazzy(), "1");
  const std::vector<std::string> arguments = {"/", "scan", "TwistStamped"};
  {
    BridgedNodes run(scanning());
    run.start();
    ASSERT_TRUE(run.says("the run waits for a node that publishes /cmd_vel"));
    const auto node = run.start_node(jazzy(), "commander.py", arguments);
    EXPECT_EQ(run.hash(), hash) << "last";
  }
  {
    BridgedNodes run(scanning());
    const auto node = run.start_node(jazzy(), "commander.py", arguments);
    ASSERT_TRUE(node->wait_for_output("ready"));
    run.start_bridge();
    run.start_server();
    EXPECT_EQ(run.hash(), hash) << "first";
  }
}

}  // namespace
}  // namespace cohort::test
