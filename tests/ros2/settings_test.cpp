// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>

#include "tests/ros2/bridged_nodes.hpp"

namespace cohort::test {
namespace {

BridgedNodes::Options with(const std::string& ros2, const std::string& experiment = "turtlebot3") {
  return {.experiment = experiment, .ros2 = ros2, .seconds = "1e6", .server = {"--speed", "1"}};
}

TEST(Ros2Settings, InvalidOptionsAndVariablesAreNamed) {
  const auto expect_refusal = [](const std::vector<std::string>& arguments, const Process::Environment& environment,
                                 const std::string& text) {
    std::vector<std::string> command = {COHORT_BUILD_DIR "/bin/cohort-ros2-bridge"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Ended ended = run_to_end(command, environment);
    EXPECT_EQ(ended.exit_code, 2) << text << ended.err;
    EXPECT_NE(ended.err.find(text), std::string::npos) << ended.err;
  };
  expect_refusal({"--ros-domain", "233"}, {}, "--ros-domain");
  expect_refusal({"--sync", "later"}, {}, "--sync");
  expect_refusal({"--ros-distro", "foxy"}, {}, "--ros-distro");
  // Before it looks for a server.
  expect_refusal({}, {{"ROS_DOMAIN_ID", "seven"}},
                 "ROS_DOMAIN_ID: invalid value 'seven', expected a number from 0 to 232");
  expect_refusal({}, {{"ROS_AUTOMATIC_DISCOVERY_RANGE", "NEAR"}},
                 "ROS_AUTOMATIC_DISCOVERY_RANGE: invalid value 'NEAR'");
  expect_refusal({}, {{"ROS_STATIC_PEERS", "a b"}}, "ROS_STATIC_PEERS: invalid peer 'a b'");
}

TEST(Ros2Settings, TopicsHaveTheNamesOfTheExperimentAndExcludedOnesAreMissing) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run(with("{namespace: /left, topics: {scan: {name: laser}, odom: {name: /odometry}, imu: false}}"));
  run.start();
  const auto node =
      run.start_node(jazzy(), "look_at_graph.py", {"/left/laser", "/odometry", "/left/cmd_vel", "/left/tf"});
  EXPECT_EQ(node->wait_for_exit(), 0);
  const auto none = run.start_node(jazzy(), "watcher.py", {"/left", "odom"});
  ASSERT_TRUE(none->wait_for_output("ready"));
  EXPECT_TRUE(run.bridge().running());
}

TEST(Ros2Settings, TheDomainIsThatOfTheOptionThenTheExperimentThenTheEnvironment) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const auto expect_domain = [](BridgedNodes::Options options, const std::string& domain) {
    options.environment = {{"ROS_DOMAIN_ID", "7"}};
    BridgedNodes run(options);
    run.start();
    const auto node = run.network().start_node(jazzy(), "watcher.py", {"/", "odom"}, {{"ROS_DOMAIN_ID", domain}});
    EXPECT_TRUE(node->wait_for_output("odom ")) << domain;
  };
  BridgedNodes::Options options = with("{namespace: /, domain: 8}");
  options.bridge = {"--ros-domain", "9"};
  expect_domain(options, "9");
  expect_domain(with("{namespace: /, domain: 8}"), "8");
  expect_domain(with("{namespace: /}"), "7");
}

TEST(Ros2Settings, ARateSkipsFrames) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run(with("{namespace: /, topics: {odom: {rate: 10}}}"));
  run.start();
  const auto node = run.start_node(jazzy(), "watcher.py", {"/", "odom"});
  ASSERT_TRUE(eventually([&] { return std::ranges::count(node->output(), '\n') > 4; })) << node->output();
  std::istringstream lines(node->output());
  std::size_t heard = 0;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("odom ")) {
      EXPECT_EQ(line.substr(line.find('.') + 2, 8), "00000000") << line;  // tenths of a second
      ++heard;
    }
  EXPECT_GT(heard, 2U);
}

TEST(Ros2Settings, ARateIsExactOnAverage) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run(with("{namespace: /, topics: {odom: {rate: 30}}}"));
  run.start();
  const auto node = run.start_node(jazzy(), "watcher.py", {"/", "odom"});
  const auto stamps = [&] {
    std::vector<double> times;
    std::istringstream lines(node->output());
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("odom ") && !lines.eof()) times.push_back(std::stod(line.substr(5)));  // with its end
    return times;
  };
  ASSERT_TRUE(eventually([&] { return stamps().size() > 60; })) << node->output();
  const std::vector<double> times = stamps();
  EXPECT_NEAR(times[60] - times[0], 2.0, 0.0101) << node->output();
}

}  // namespace
}  // namespace cohort::test
