// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <tuple>
#include <utility>

#include "server/recording/mcap/reading/mcap_reader.hpp"
#include "tests/ros2/bridged_nodes.hpp"

/// Recordings as ROS 2 has them: bags, for a reader that is not ours, and messages for nodes that are not ours.
namespace cohort::test {
namespace {

// A TurtleBot3 that drives for two seconds, recorded into a folder of its own.
class Ros2Recordings : public ::testing::Test {
 protected:
  Ros2Recordings() {
    std::filesystem::create_directory(folder());
    run_experiment(COHORT_SOURCE_DIR "/worlds/experiments/turtlebot3.yaml",
                   {"--duration", "2", "--controllers", "inprocess", "--record", file(), "--record-observations", "10",
                    "--record-rosbag2"});
  }
  std::string folder() const { return scratch_ / "bag"; }
  std::string file() const { return folder() + "/run.mcap"; }

  // `TOPIC TIME` of the messages on topics of this kind, in the order of time, the clock last at each time. With each
  // observation, the transforms of the bridge are played too.
  std::vector<std::string> recorded(const std::vector<std::string>& topics, std::uint64_t from = 0) const {
    std::vector<std::tuple<std::uint64_t, bool, std::string>> messages;
    const recording::McapReader reader(file());
    bool is_first = true;
    for (recording::MessageStream stream = reader.messages(); const auto message = stream.next();) {
      const std::string& topic = reader.channels().at(message->channel).topic;
      if (std::ranges::find(topics, topic) != topics.end())
        messages.emplace_back(message->log_time.count(), topic == "/clock", topic);
      if (topic != "/turtlebot3/observation") continue;
      if (std::exchange(is_first, false)) messages.emplace_back(message->log_time.count(), false, "/tf_static");
      messages.emplace_back(message->log_time.count(), false, "/tf");
    }
    std::ranges::stable_sort(messages, {},
                             [](const auto& each) { return std::pair(std::get<0>(each), std::get<1>(each)); });
    std::vector<std::string> lines;
    for (const auto& [time, is_clock, topic] : messages)
      if (time >= from || topic == "/tf_static") lines.push_back(topic + " " + std::to_string(time));
    return lines;
  }

  const ScratchFolder scratch_;
};

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

#ifdef COHORT_ROSBAGS_PYTHON

Ended read_bag(const std::string& folder) {
  return run_to_end({COHORT_ROSBAGS_PYTHON, COHORT_SOURCE_DIR "/tests/ros2/read_bag.py", folder});
}

void expect_bag_of_the_run(const Ended& bag) {
  ASSERT_EQ(bag.exit_code, 0) << bag.err;
  for (const char* line :
       {"/clock rosgraph_msgs/msg/Clock 21 volatile\n", "/tf_static tf2_msgs/msg/TFMessage 1 transient_local\n",
        "/turtlebot3/scan sensor_msgs/msg/LaserScan 11 volatile\n",
        "/cohort/boundary cohort_msgs/msg/Boundary 201 volatile\n", "\n/turtlebot3/scan 200000000 200000000\n",
        "\n/turtlebot3/imu 2000000000 2000000000\n", "\n/clock 1500000000 1500000000\n", "\n/tf_static 0 0\n",
        "\n/turtlebot3/observation 700000000 700000000\n"})
    EXPECT_NE(bag.out.find(line), std::string::npos) << line << bag.out;
}

TEST_F(Ros2Recordings, AreBagsOfRosbag2) { expect_bag_of_the_run(read_bag(folder())); }

TEST_F(Ros2Recordings, BecomeBagsOfRosbag2Later) {
  std::filesystem::remove(folder() + "/metadata.yaml");
  EXPECT_NE(read_bag(folder()).exit_code, 0);
  const Ended ended = run_to_end({cohort_program(), "recordings", "rosbag2", file()});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  expect_bag_of_the_run(read_bag(folder()));
}

#else

TEST(Ros2Recordings, AreBagsOfRosbag2) {
  GTEST_SKIP() << "no environment of tools/dev/python-environment --rosbags (COHORT_ROSBAGS_PYTHON)";
}

#endif

TEST_F(Ros2Recordings, AreNotAppendedToBagsOfOtherRecordings) {
  const std::string other = folder() + "/other.mcap";
  std::filesystem::copy_file(file(), other);
  const std::string error =
      "metadata.yaml describes recordings other than other.mcap; each rosbag2 bag requires its own folder";
  const Ended made = run_to_end({cohort_program(), "recordings", "rosbag2", other});
  EXPECT_NE(made.exit_code, 0);
  EXPECT_NE(made.err.find(error), std::string::npos) << made.err;
  // A run says so before it begins.
  const std::string experiment = COHORT_SOURCE_DIR "/worlds/experiments/turtlebot3.yaml";
  std::filesystem::remove(other);
  const Ended run = run_to_end({cohort_program(), "run", experiment, "--record", other, "--record-rosbag2"});
  EXPECT_NE(run.err.find(error), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(other));
  const Ended runs = run_to_end(
      {cohort_program(), "run", experiment, "--repeat", "2", "--record", scratch_ / "run.mcap", "--record-rosbag2"});
  EXPECT_NE(runs.err.find("'--record-rosbag2' cannot be used with several runs"), std::string::npos) << runs.err;
}

TEST_F(Ros2Recordings, ArePlayedToNodesInTheirOrder) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::vector<std::string> topics = {
      "/clock", "/tf", "/tf_static", "/turtlebot3/scan", "/turtlebot3/imu", "/turtlebot3/joint_states"};
  const std::vector<std::string> types = {"rosgraph_msgs/Clock",   "tf2_msgs/TFMessage", "tf2_msgs/TFMessage",
                                          "sensor_msgs/LaserScan", "sensor_msgs/Imu",    "sensor_msgs/JointState"};
  for (const Ros2Distribution& distribution : ros2_distributions())
    for (const char* from : {"0", "1"}) {
      const std::vector<std::string> expected = recorded(topics, std::stoull(from) * 1'000'000'000);
      ASSERT_GE(expected.size(), 60U);
      std::vector<std::string> arguments = {std::to_string(expected.size())};
      for (std::size_t i = 0; i < topics.size(); ++i) arguments.push_back(topics[i] + "=" + types[i]);
      const OwnNetwork network;
      const auto listener =
          network.start_node(distribution, "listen.py", arguments,
                             {{"PYTHONPATH", build_interfaces(distribution, COHORT_SOURCE_DIR "/tests/ros2/interfaces",
                                                              "tested", {"tf2_msgs", "echo_interfaces"})}});
      const auto player =
          network.start({cohort_program(), "replay", file(), "--ros2", "--speed", "10", "--wait", "6", "--from", from});
      ASSERT_EQ(player->wait_for_exit(), 0) << player->output() << listener->output();
      EXPECT_NE(player->output().find("playing 10 topics to ROS 2 nodes in domain 0\n"), std::string::npos)
          << player->output();
      ASSERT_EQ(listener->wait_for_exit(), 0) << listener->output();
      EXPECT_EQ(listener->output(), joined(expected)) << distribution.name;
    }
}

std::vector<std::string> lines_of(const std::string& output, const std::string& topic) {
  std::vector<std::string> found;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(topic + " ")) found.push_back(line);
  return found;
}

TEST(Ros2Replay, PublishesTheOdometryAndTheScansOfTheRun) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const std::vector<std::string> watched = {"/", "odom", "scan", "joint_states"};
  const ScratchFolder folder;
  const std::string file = folder / "run.mcap";
  BridgedNodes run({.experiment = "turtlebot3",
                    .ros2 = "{sync: command, namespace: /, base_frame: base_footprint, topics: {scan: {rate: 5}}}",
                    .seconds = "3",
                    .server = {"--record", file, "--record-observations", "100"}});
  run.start();
  const auto live = run.start_node(jazzy(), "watcher.py", watched);
  // First, as it hears nothing after the run.
  ASSERT_TRUE(live->wait_for_output("found"));
  const auto commander = run.start_node(jazzy(), "commander.py", {"/", "scan", "Twist"});
  run.summary();
  for (const std::string from : {"0", "1"}) {
    const OwnNetwork network;
    const auto node = network.start_node(jazzy(), "watcher.py", watched);
    const auto player =
        network.start({cohort_program(), "replay", file, "--ros2", "--speed", "2", "--wait", "3", "--from", from});
    ASSERT_EQ(player->wait_for_exit(), 0) << player->output();
    for (const auto& least : {std::pair("odom", 150U), {"scan", 8U}, {"joint_states", 150U}}) {
      const std::string topic = least.first;
      const std::size_t count = least.second;
      const std::vector<std::string> expected = lines_of(live->output(), topic);
      ASSERT_FALSE(expected.empty()) << topic;
      const auto stamp_of = [&](const std::string& line) { return std::stod(line.substr(topic.size())); };
      ASSERT_TRUE(eventually([&] { return lines_of(node->output(), topic).size() > count; })) << topic;
      for (const std::string& line : lines_of(node->output(), topic)) {
        if (line.starts_with(topic + " 3.0")) continue;             // the end of the run, which has no frame
        if (stamp_of(line) < stamp_of(expected.front())) continue;  // before the run knew the live node
        ASSERT_NE(std::ranges::find(expected, line), expected.end()) << line;
      }
    }
  }
}

TEST_F(Ros2Recordings, CannotBePlayedAndRunAgainAtOnce) {
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--ros2", "--verify"}, {"--ros2", "--threads", "2"}, {"--speed", "2"}, {"--loop"}}) {
    std::vector<std::string> command = {cohort_program(), "replay", file()};
    command.insert(command.end(), options.begin(), options.end());
    EXPECT_EQ(run_to_end(command).exit_code, 2) << options.front();
  }
}

}  // namespace
}  // namespace cohort::test
