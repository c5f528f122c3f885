// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <sstream>

#include "tests/ros2/bridged_nodes.hpp"

namespace cohort::test {
namespace {

// Values of the first line that a watcher prints of a topic, after the stamp.
std::vector<double> first_values(Process& watcher, const std::string& topic) {
  const std::string head = "\n" + topic + " ";
  const auto line_of = [&] {
    const std::string output = watcher.output();
    const std::size_t begin = output.find(head);
    const std::size_t end = begin == std::string::npos ? begin : output.find('\n', begin + 1);
    return end == std::string::npos ? std::string() : output.substr(begin + head.size(), end - begin - head.size());
  };
  if (!eventually([&] { return !line_of().empty(); })) return {};
  std::istringstream words(line_of());
  std::string word;
  words >> word;
  std::vector<double> values;
  while (words >> word) values.push_back(std::stod(word));
  return values;
}

BridgedNodes::Options with_truth(const std::string& experiment, const std::string& ros2) {
  return {.experiment = experiment, .ros2 = ros2, .seconds = "1e6", .server = {"--speed", "1"}};
}

TEST(Ros2Robots, HaveTrueOdometryFromTheirPose) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run(with_truth("turtlebot3", "{sync: free, namespace: /, odometry: truth}"));
  run.start();
  const auto node = run.start_node(kilted(), "watcher.py", {"/", "odom"});
  const std::vector<double> odometry = first_values(*node, "odom");
  ASSERT_EQ(odometry.size(), 5U) << node->output() << run.bridge().output();
  EXPECT_NEAR(odometry[0], -1.5, 0.01);
  EXPECT_NEAR(odometry[1], -1.2, 0.01);
}

TEST(Ros2Robots, WithoutEncodersHaveTrueOdometry) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run(with_truth("quadcopters", "{sync: free, odometry: truth}"));
  run.start();
  const auto node = run.start_node(jazzy(), "watcher.py", {"/copter_1", "odom"});
  const std::vector<double> odometry = first_values(*node, "odom");
  ASSERT_EQ(odometry.size(), 5U) << node->output() << run.bridge().output();
  EXPECT_NEAR(odometry[0], -0.5, 0.01);
  EXPECT_NEAR(odometry[1], 0.0, 0.01);
  EXPECT_NEAR(odometry[2], 0.5, 0.01);
}

TEST(Ros2Robots, ReportInfiniteRangesWithoutAnObstacle) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run(with_truth("gate", "{sync: free, namespace: /}"));
  run.start();
  std::vector<std::string> arguments = {"/"};
  for (int i = 0; i < 15; ++i) arguments.push_back("range/proximity_" + std::to_string(i));
  arguments.push_back("range/ground_0");
  const auto node = run.start_node(jazzy(), "watcher.py", arguments);
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::vector<double> range = first_values(*node, arguments[i]);
    ASSERT_EQ(range.size(), 3U) << arguments[i] << node->output() << run.bridge().output();
    EXPECT_NEAR(range[2], i + 1 < arguments.size() ? 0.2 : 0.04, 1e-6) << arguments[i];
    EXPECT_TRUE(std::isinf(range[0]) || (range[0] > range[1] && range[0] <= range[2])) << arguments[i];
  }
  EXPECT_LT(first_values(*node, "range/ground_0")[0], 0.03) << "the floor is far";
  EXPECT_TRUE(eventually([&] { return node->output().find(" inf ") != std::string::npos; })) << node->output();
}

TEST(Ros2Robots, ListenToTheTopicOfTheExperiment) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run(
      {.experiment = "turtlebot3", .ros2 = "{sync: command, namespace: /, reply_to: odom}", .seconds = "1"});
  run.start();
  const auto node = run.start_node(jazzy(), "commander.py", {"/", "odom", "Twist"});
  EXPECT_FALSE(run.hash().empty());
}

TEST(Ros2Robots, WithTheirOwnBridgeAreDrivenByNodesOrByTheirControllers) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const OwnNetwork network;
  const auto run = [&](const std::string& robots, const std::vector<std::string>& options) {
    const ScratchFolder folder;
    const std::filesystem::path worlds = COHORT_SOURCE_DIR "/worlds";
    std::string experiment = read_file(worlds / "experiments/quadcopters.yaml");
    const std::string arenas = "../arenas/";
    experiment.replace(experiment.find(arenas), arenas.size(), (worlds / "arenas/").string());
    std::ofstream(folder / "experiment.yaml") << experiment << "\nros2: {robots: " << robots << "}\n";
    std::vector<std::string> command = {cohort_program(),
                                        "run",
                                        (folder / "experiment.yaml").string(),
                                        "--duration",
                                        "1",
                                        "--summary",
                                        (folder / "summary.json").string()};
    command.insert(command.end(), options.begin(), options.end());
    const auto process = network.start(command);
    EXPECT_EQ(process->wait_for_exit(), 0) << process->output();
    return read_json(folder / "summary.json")["state_hash"].get<std::string>();
  };
  const std::string alone = run("copter_1", {});
  const std::string one = run("copter_1", {"--ros2"});
  const std::string two = run("[copter_1, copter_2]", {"--ros2"});
  EXPECT_NE(one, alone) << "its controller still drives it";
  EXPECT_NE(one, two) << "no controller drives the others";
}

}  // namespace
}  // namespace cohort::test
