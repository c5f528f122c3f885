// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "server/recording/recording.hpp"
#include "tools/bridges/ros2/robots/drive.hpp"
#include "tools/bridges/ros2/robots/publications.hpp"

namespace cohort::tool {

/// The topics on which cohort-ros2-bridge publishes robots, such as `odom` and `tf`, from their recorded observations.
/// Topics of the same name in the recording are left out. Not thread-safe.
class ReplayedRobots {
 public:
  /// `recorded`: names of topics. Throws McapError, InputError, or std::runtime_error for settings that do not fit.
  ReplayedRobots(ros2::RosParticipant& participant, const std::filesystem::path& file,
                 const std::set<std::string>& recorded);

  /// Returns the channels whose messages `publish` and `follow` need.
  const std::vector<recording::ChannelId>& channels() const { return channels_; }
  /// Publishes the messages that the bridge would publish at a recorded message.
  void publish(const recording::Message& message) { take(message, true); }
  /// Updates the robots' odometry by a message before the published part.
  void follow(const recording::Message& message) { take(message, false); }
  /// Starts again at the beginning of the recording.
  void restart();

  std::vector<ros2::Publications::PublishedTopic> topics() const;
  std::uint64_t dropped() const;
  bool is_received() const;
  /// Returns true if the participant is announced to all subscribers.
  bool is_known_to_subscribers(const ros2::RosParticipant& participant) const;

 private:
  struct Robot {
    std::string name;
    std::chrono::nanoseconds step{0};
    std::optional<ros2::Drive> drive;
    std::unique_ptr<ros2::Publications> publications;
    std::optional<std::chrono::nanoseconds> time;  // time of the last observation
  };
  static std::unique_ptr<Robot> make_robot(ros2::RosParticipant& participant, const description::Experiment& experiment,
                                           const recording::Roster& roster, std::uint32_t robot,
                                           const std::set<std::string>& recorded);
  void take(const recording::Message& message, bool is_published);
  void observe(Robot& robot, recording::ByteView bytes, bool is_published);

  std::vector<recording::ChannelId> channels_;
  std::map<recording::ChannelId, std::unique_ptr<Robot>> robots_;  // by the channels of their observations
  std::optional<recording::ChannelId> poses_;                      // if they are needed
  std::map<std::string, WorldPose> pose_of_;                       // by the names of robots
};

}  // namespace cohort::tool
