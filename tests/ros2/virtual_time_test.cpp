// SPDX-License-Identifier: Apache-2.0
#include <sstream>

#include "tests/ros2/bridged_nodes.hpp"

namespace cohort::test {
namespace {

std::string node(const Ros2Distribution& distribution, const std::string& arguments) {
  return distribution.python + " -u " COHORT_SOURCE_DIR "/tests/ros2/timed_node.py " + arguments;
}

// Two nodes, each with a robot of its own, started by one command.
struct TwoNodes {
  std::string hash;  // state hash of the run
  std::string told;  // output of the nodes
};

// `of_first`: arguments of the first node after its robot.
TwoNodes run_two(const Ros2Distribution& distribution, const std::string& threads,
                 const std::string& of_first = "0.1") {
  BridgedNodes::Options options{.experiment = "arduino", .seconds = "3", .threads = threads};
  const std::string first = node(distribution, "/robot_0 " + of_first);
  options.bridge = {"--run", first + " & " + node(distribution, "/robot_1") + " & wait"};
  BridgedNodes run(options);
  run.start();
  TwoNodes result{run.hash(), {}};
  // Which of the two prints first is left to the machine.
  std::vector<std::string> lines;
  std::istringstream output(run.bridge().output());
  for (std::string line; std::getline(output, line);)
    if (line.find(" s: ") != std::string::npos && line[0] < '3') lines.push_back(line);
  std::ranges::sort(lines);
  for (const std::string& line : lines) result.told += line + "\n";
  return result;
}

TEST(NodesInVirtualTime, DriveByTheirTimersToTheSameStateAgainAndWithAnyThreads) {
  for (const Ros2Distribution& distribution : ros2_distributions()) {
    if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
    const TwoNodes first = run_two(distribution, "1");
    EXPECT_EQ(std::ranges::count(first.told, '\n'), 4) << first.told;
    EXPECT_NE(first.told.find("1 s: "), std::string::npos) << first.told;
    EXPECT_NE(first.told.find(" 0 at another time"), std::string::npos) << first.told;
    EXPECT_EQ(first.told.find(" 1 at another time"), std::string::npos) << first.told;
    const TwoNodes second = run_two(distribution, "2");
    EXPECT_EQ(second.hash, first.hash) << distribution.name;
    EXPECT_EQ(second.told, first.told) << distribution.name;
  }
}

TEST(NodesInVirtualTime, DecideTheState) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  EXPECT_NE(run_two(jazzy(), "1", "0.11").hash, run_two(jazzy(), "1").hash);
}

TEST(NodesInVirtualTime, OfManyThreadsDriveToTheSameStateAgainAndWithAnyThreads) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string four_threads = "0.1 inf 4";
  const TwoNodes first = run_two(jazzy(), "1", four_threads);
  EXPECT_EQ(std::ranges::count(first.told, '\n'), 4) << first.told;
  for (const char* threads : {"1", "2"}) {
    const TwoNodes again = run_two(jazzy(), threads, four_threads);
    EXPECT_EQ(again.hash, first.hash);
    EXPECT_EQ(again.told, first.told);
  }
}

TEST(NodesInVirtualTime, ThatExitDoNotStopTheRun) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes::Options options{.experiment = "arduino", .seconds = "3"};
  options.bridge = {"--run", node(jazzy(), "/robot_0 0.1 1")};
  BridgedNodes run(options);
  run.start();
  EXPECT_EQ(run.summary()["ticks"], 300);
  EXPECT_TRUE(run.says("has ended with the exit code 3"));
}

TEST(NodesInVirtualTime, ThatAreNotNodesAreReported) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes::Options options{.experiment = "arduino", .seconds = "0.1"};
  options.bridge = {"--run", "sleep 1000"};
  BridgedNodes run(options);
  run.start();
  EXPECT_TRUE(run.says("no node of 'sleep 1000' has appeared in ROS domain 0: the run begins without it"));
  run.summary();
}

TEST(RosIdle, NeedsNodesThatTheBridgeStarts) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run({.experiment = "arduino", .ros2 = "{sync: idle}", .seconds = "1"});
  run.start();
  EXPECT_TRUE(
      run.says("robot robot_0 has 'sync: idle', which requires --run COMMAND: the bridge must start its nodes"));
}

}  // namespace
}  // namespace cohort::test
