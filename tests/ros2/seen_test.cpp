// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <sstream>

#include "tests/ros2/bridged_nodes.hpp"

namespace cohort::test {
namespace {

BridgedNodes::Options free_turtlebot() {
  return {.experiment = "turtlebot3",
          .ros2 = "{sync: free, namespace: /, base_frame: base_footprint}",
          .seconds = "1e6",
          .server = {"--speed", "1"},
          .bridge = {"--no-services"}};
}

TEST(Ros2Seen, TheGraphHasEveryTopicWithTypeAndQualityOfService) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  for (const Ros2Distribution& distribution : ros2_distributions()) {
    BridgedNodes run(free_turtlebot());
    run.start();
    const auto node =
        run.start_node(distribution, "look_at_graph.py",
                       {"/clock", "/scan", "/odom", "/imu", "/joint_states", "/tf", "/tf_static", "/cmd_vel"});
    EXPECT_EQ(node->wait_for_exit(), 0);
    EXPECT_EQ(node->output(),
              "/clock cohort publishes rosgraph_msgs/msg/Clock RELIABLE VOLATILE same\n"
              "/scan cohort publishes sensor_msgs/msg/LaserScan RELIABLE VOLATILE same\n"
              "/odom cohort publishes nav_msgs/msg/Odometry RELIABLE VOLATILE same\n"
              "/imu cohort publishes sensor_msgs/msg/Imu RELIABLE VOLATILE same\n"
              "/joint_states cohort publishes sensor_msgs/msg/JointState RELIABLE VOLATILE same\n"
              "/tf cohort publishes tf2_msgs/msg/TFMessage RELIABLE VOLATILE unknown\n"
              "/tf_static cohort publishes tf2_msgs/msg/TFMessage RELIABLE TRANSIENT_LOCAL unknown\n"
              "/cmd_vel cohort subscribes geometry_msgs/msg/Twist RELIABLE VOLATILE same\n"
              "nodes ['cohort', 'looker']\n"
              "types of /clock ['rosgraph_msgs/msg/Clock']\n")
        << distribution.name;
  }
}

using TimesByStamp = std::map<std::int64_t, std::int64_t>;

// Returns the times that tell_time.py printed of one kind.
TimesByStamp times_in(const std::string& output, const std::string& kind) {
  std::istringstream lines(output);
  TimesByStamp times;
  std::string word;
  std::int64_t stamp = 0, sent = 0;
  while (lines >> word >> stamp >> sent)
    if (word == kind) times[stamp] = sent;
  return times;
}

TEST(Ros2Seen, ClocksFollowTheDataOfTheirFrameAndDriveTimers) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  for (const Ros2Distribution& distribution : ros2_distributions()) {
    BridgedNodes run(free_turtlebot());
    run.start();
    const auto node = run.start_node(distribution, "tell_time.py", {});
    ASSERT_TRUE(eventually([&] { return times_in(node->output(), "timer").size() > 5; })) << run.bridge().output();
    const std::string output = node->output();
    const TimesByStamp odometry = times_in(output, "odom"), clocks = times_in(output, "clock");
    std::size_t both = 0;
    for (const auto& [stamp, sent] : odometry)
      if (const auto clock = clocks.find(stamp); clock != clocks.end()) {
        EXPECT_LT(sent, clock->second) << stamp;
        ++both;
      }
    EXPECT_GT(both, 20U);
    constexpr std::int64_t step = 10'000'000;
    for (const TimesByStamp& times : {odometry, clocks, times_in(output, "timer")})
      for (const auto& [stamp, sent] : times) EXPECT_EQ(stamp % step, 0) << stamp;
    for (auto clock = std::next(clocks.begin()); clock != clocks.end(); ++clock) {
      EXPECT_EQ(clock->first - std::prev(clock)->first, step);
      EXPECT_GT(clock->second, std::prev(clock)->second);
    }
  }
}

// Values of the last line that a watcher printed of a topic: the stamp first.
std::vector<double> last_values(const std::string& output, const std::string& topic) {
  std::vector<double> values;
  std::istringstream lines(output.substr(0, output.rfind('\n') + 1));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    words >> name;
    if (name != topic) continue;
    values.clear();
    for (std::string word; words >> word;) values.push_back(std::stod(word));
  }
  return values;
}

TEST(Ros2Seen, AScannerMeasuresTheHouse) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  BridgedNodes run(free_turtlebot());
  run.start();
  const auto node = run.start_node(jazzy(), "watcher.py", {"/", "scan"});
  ASSERT_TRUE(eventually([&] { return !last_values(node->output(), "scan").empty(); })) << node->output();
  const std::vector<double> scan = last_values(node->output(), "scan");
  const double first = scan[1], increment = scan[2];
  const auto range_at = [&](double angle) {
    return scan[3 + static_cast<std::size_t>(std::llround((angle - first) / increment))];
  };
  ASSERT_EQ(scan.size(), 3U + 360U);
  // It stands at (-1.5, -1.2), its scanner 32 mm behind, with a wall at y = -2 and a cupboard up to x = -2.45.
  EXPECT_NEAR(range_at(first + std::fmod(1.5 * M_PI - first, 2 * M_PI)), 0.8, 0.06);
  EXPECT_NEAR(range_at(M_PI), 2.45 - 1.532, 0.06);
}

}  // namespace
}  // namespace cohort::test
