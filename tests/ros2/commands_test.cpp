// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <sstream>

#include "tests/ros2/bridged_nodes.hpp"

namespace cohort::test {
namespace {

// Waits until a watcher's last whole line has, as its value at `place`, one that `is_right` likes.
template <class IsRight>
testing::AssertionResult comes_to_say(Process& watcher, std::size_t place, const IsRight& is_right) {
  const auto is_said = [&] {
    const std::string output = watcher.output();
    const std::size_t end = output.rfind('\n');
    if (end == std::string::npos || end == 0) return false;
    const std::size_t begin = output.rfind('\n', end - 1);
    std::istringstream words(output.substr(begin == std::string::npos ? 0 : begin + 1));
    std::string word;
    for (std::size_t i = 0; i <= place + 2; ++i)
      if (!(words >> word)) return false;
    return is_right(std::stod(word));
  };
  if (eventually(is_said)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << watcher.output();
}

TEST(Ros2Commands, JointsFollowTheTopicOfTheirController) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run({.experiment = "arm", .ros2 = "{sync: free}", .seconds = "1e6", .server = {"--speed", "1"}});
  run.start();
  const auto watcher = run.start_node(jazzy(), "watcher.py", {"/arm", "joint_states"});
  const auto node =
      run.start_node(kilted(), "move_joints.py", {"/arm/velocity_controller/commands", "0.5", "0", "-0.5"});
  EXPECT_TRUE(comes_to_say(*watcher, 0, [](double turn) { return turn > 0.2; }));
  EXPECT_TRUE(comes_to_say(*watcher, 2, [](double bend) { return bend < -0.2; }));
  EXPECT_TRUE(comes_to_say(*watcher, 1, [](double lift) { return std::abs(lift) < 0.02; }));
}

TEST(Ros2Commands, AnotherNodeMayCommandByAnotherTypeAndBestEffort) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run(
      {.experiment = "turtlebot3", .ros2 = "{sync: free, namespace: /}", .seconds = "1e6", .server = {"--speed", "1"}});
  run.start();
  const auto watcher = run.start_node(jazzy(), "watcher.py", {"/", "odom"});
  const std::vector<std::pair<std::string, double>> commands = {
      {"Twist", 0.1}, {"TwistStamped", -0.1}, {"BestEffort", 0.15}, {"Twist", -0.15}};
  for (const auto& [command, speed] : commands) {
    const auto node = run.start_node(kilted(), "commander.py", {"/", "odom", command, std::to_string(speed)});
    EXPECT_TRUE(comes_to_say(*watcher, 3, [&](double linear) { return std::abs(linear - speed) < 0.02; })) << command;
    node->signal(SIGINT);
    node->wait_for_exit();
  }
}

}  // namespace
}  // namespace cohort::test
