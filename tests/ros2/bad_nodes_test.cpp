// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <sstream>

#include "tests/ros2/bridged_nodes.hpp"

namespace cohort::test {
namespace {

const std::vector<std::string> good_commander = {"/", "scan", "Twist"};

BridgedNodes::Options turtlebot(const std::string& more, const std::string& seconds = "3") {
  return {.experiment = "turtlebot3",
          .ros2 = "{sync: command, namespace: /, topics: {scan: {rate: 5}}" + more + "}",
          .seconds = seconds};
}

// The same, until it stops at the fifth scan.
const std::vector<std::string> stopping_commander = {"/", "scan", "Twist", "0.1", "5"};

std::string undisturbed_hash() {
  BridgedNodes run(turtlebot(""));
  run.start();
  const auto node = run.start_node(jazzy(), "commander.py", good_commander);
  return run.hash();
}

// Linear velocity of the last odometry that a watcher printed.
double last_speed(const std::string& output) {
  std::istringstream lines(output);
  double speed = 0.0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string topic;
    double time = 0.0, x = 0.0, y = 0.0, heading = 0.0, linear = 0.0;
    if (words >> topic >> time >> x >> y >> heading >> linear && topic == "odom") speed = linear;
  }
  return speed;
}

TEST(Ros2BadNodes, ARobotStopsOrKeepsItsCommandWhenItsNodeIsKilled) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  for (const bool stands : {true, false}) {
    BridgedNodes run(turtlebot(stands ? ", wait: 0.1, on_silence: stand" : ", wait: 0.1, on_silence: hold", "1e6"));
    run.start();
    const auto watcher = run.start_node(jazzy(), "watcher.py", {"/", "odom"});
    const auto node = run.start_node(jazzy(), "commander.py", good_commander);
    ASSERT_TRUE(run.says("/commander commands it"));
    ASSERT_TRUE(eventually([&] { return last_speed(watcher->output()) > 0.05; })) << watcher->output();
    node->signal(SIGKILL);
    EXPECT_TRUE(
        run.says(stands ? ": the robot stands until a command arrives" : ": the robot keeps its last command until"));
    EXPECT_TRUE(run.says("robot turtlebot3: no /cmd_vel from /commander for tick "));
    const std::size_t heard = watcher->output().size();
    const auto is_heard_again = [&] { return watcher->output().size() > heard + 4000; };
    ASSERT_TRUE(eventually(is_heard_again)) << "the run does not go on";
    EXPECT_TRUE(eventually([&] { return stands == (std::abs(last_speed(watcher->output())) < 0.02); }))
        << watcher->output();
  }
}

TEST(Ros2BadNodes, ARunWaitsForAStoppedNode) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string hash = undisturbed_hash();
  BridgedNodes run(turtlebot(""));
  run.start();
  const auto node = run.start_node(jazzy(), "commander.py", stopping_commander);
  EXPECT_TRUE(run.says("robot turtlebot3: the run waits at tick 80 for /cmd_vel from "));
  node->signal(SIGCONT);
  EXPECT_EQ(run.hash(), hash);
}

TEST(Ros2BadNodes, ANodeThatSubscribesOnceMoreHearsTheFrameAgain) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string hash = undisturbed_hash();
  BridgedNodes run(turtlebot(""));
  run.start();
  const auto node = run.start_node(jazzy(), "resubscriber.py");
  EXPECT_EQ(run.hash(), hash);
  EXPECT_NE(node->output().find("subscribed again\n"), std::string::npos) << node->output();
}

TEST(Ros2BadNodes, TheRunNamesTheNodeThatItWaitsFor) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run(turtlebot("", "1e6"));
  run.start();
  auto node = run.start_node(jazzy(), "commander.py", good_commander);
  ASSERT_TRUE(run.says("robot turtlebot3: /commander commands it\n"));
  node->signal(SIGSTOP);
  EXPECT_TRUE(run.says(" for /cmd_vel from /commander\n"));
  node->signal(SIGCONT);
  node->signal(SIGINT);
  EXPECT_TRUE(run.says("robot turtlebot3: /commander no longer commands it\n"));
  node = run.start_node(kilted(), "commander.py", good_commander);
  EXPECT_TRUE(run.says("robot turtlebot3: /commander has ended\n"));
  EXPECT_TRUE(run.says("robot turtlebot3: /commander commands it\n"));
}

TEST(Ros2BadNodes, ANodeReplacesAKilledOne) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string hash = undisturbed_hash();
  BridgedNodes run(turtlebot(""));
  run.start();
  auto node = run.start_node(jazzy(), "commander.py", stopping_commander);
  EXPECT_TRUE(run.says("the run waits at tick 80 for /cmd_vel from "));
  node->signal(SIGKILL);
  node = run.start_node(kilted(), "commander.py", good_commander);
  EXPECT_EQ(run.hash(), hash);
}

TEST(Ros2BadNodes, ARunDoesNotWaitForStoppedNodesWithoutCommands) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string hash = undisturbed_hash();
  BridgedNodes run(turtlebot(""));
  run.start();
  // First, as it hears nothing after tick 80.
  const auto watcher = run.start_node(jazzy(), "watcher.py", {"/", "scan", "odom", "/clock"});
  ASSERT_TRUE(watcher->wait_for_output("found"));
  const auto node = run.start_node(jazzy(), "commander.py", stopping_commander);
  EXPECT_TRUE(run.says("the run waits at tick 80 "));
  EXPECT_TRUE(watcher->wait_for_output("odom"));
  watcher->signal(SIGSTOP);
  node->signal(SIGCONT);
  EXPECT_EQ(run.hash(), hash);
}

TEST(Ros2BadNodes, AnInvalidMessageIsReportedWithTheNodesName) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const auto expect_text = [](const BridgedNodes::Options& options, const std::vector<std::string>& odd,
                              const std::string& text) {
    BridgedNodes run(options);
    run.start();
    const auto node = run.start_node(jazzy(), "odd_commander.py", odd);
    EXPECT_TRUE(run.says(text));
  };
  const std::string stands = ", wait: 0.05, on_silence: stand";
  expect_text(turtlebot(stands, "1e6"), {"/cmd_vel", "nan"},
              "robot turtlebot3: /cmd_vel from /odd: a value is not finite; this message is ignored\n");
  const BridgedNodes::Options arm{
      .experiment = "arm", .ros2 = "{sync: command, namespace: /" + stands + "}", .seconds = "1e6"};
  expect_text(
      arm, {"/velocity_controller/commands", "short"},
      "robot arm: /velocity_controller/commands from /odd: it has 1 values; expected 3, one for each motor; this "
      "message is ignored\n");
}

TEST(Ros2BadNodes, ANodeWithAnotherTypeIsReportedAndIgnored) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string hash = undisturbed_hash();
  BridgedNodes run(turtlebot(""));
  run.start();
  const auto odd = run.start_node(jazzy(), "odd_commander.py", {"/cmd_vel", "foreign"});
  EXPECT_TRUE(
      run.says("robot turtlebot3: /cmd_vel from /odd is a std_msgs/msg/String; expected a geometry_msgs/msg/Twist or "
               "geometry_msgs/msg/TwistStamped\n"));
  const auto node = run.start_node(jazzy(), "commander.py", good_commander);
  EXPECT_EQ(run.hash(), hash);
}

TEST(Ros2BadNodes, InvalidBytesAreReportedAndIgnored) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string hash = undisturbed_hash();
  const std::vector<std::string> garbage = {
      "00010000",                         // a header alone
      "0001000001020304",                 // cut off
      "00030000" + std::string(96, '0'),  // parameter lists
      "00010000" + std::string(96, 'f'),  // numbers that are none
  };
  for (const std::string& bytes : garbage) {
    BridgedNodes run(turtlebot(""));
    run.start();
    const auto stray =
        run.network().start({COHORT_BUILD_DIR "/bin/ros_writer", "/cmd_vel", "geometry_msgs/msg/Twist", bytes});
    EXPECT_TRUE(run.says("robot turtlebot3: /cmd_vel from /stray: ")) << bytes;
    EXPECT_TRUE(run.says("; this message is ignored\n")) << bytes;
    const auto node = run.start_node(jazzy(), "commander.py", good_commander);
    EXPECT_EQ(run.hash(), hash) << bytes;
  }
}

}  // namespace
}  // namespace cohort::test
