// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/include/cohort/client.hpp"
#include "idl/dds/ros2/ros_participant.hpp"
#include "idl/include/cohort/types.hpp"
#include "idl/messages/ros_navigation_messages.hpp"
#include "server/core/periodic_ticks.hpp"
#include "server/messages/device_messages.hpp"
#include "tools/bridges/ros2/robots/drive.hpp"
#include "tools/bridges/ros2/robots/frame_tree.hpp"
#include "tools/bridges/ros2/robots/settings.hpp"

namespace cohort::ros2 {

/// The topics on which the frames of one robot are published.
class Publications {
 public:
  Publications(const Publications&) = delete;
  Publications& operator=(const Publications&) = delete;

  /// `matched` is called on threads of DDS when a subscriber appears. `drive` may be nullptr, and must outlive this.
  /// Throws std::runtime_error for settings that do not fit the robot.
  Publications(RosParticipant& participant, const description::Model& model, const DrivenRobot& robot,
               const RobotSettings& settings, Drive* drive, const std::function<void()>& matched);

  /// Begins a run, or continues with another one. Publishes the static transforms.
  void begin(std::chrono::nanoseconds time);
  /// Returns whether `odom` has the robot's true pose instead of the encoders' odometry.
  bool wants_true_pose() const { return tells_truth_; }
  /// Publishes the messages that are due at a frame. `truth` is the robot's pose in the world, if wants_true_pose().
  void publish(std::span<const double> observation, std::uint64_t tick, std::chrono::nanoseconds time,
               const std::optional<WorldPose>& truth);
  /// Updates the odometry by a frame without publishing.
  void follow(std::span<const double> observation, std::chrono::nanoseconds time,
              const std::optional<WorldPose>& truth);
  /// Publishes messages of the last frame again for those of these participants that have subscribed since. Only topics
  /// that such a participant has not received are published. Returns whether anything was published.
  bool publish_to_newcomers(std::span<const Gid> participants);
  /// Publishes all messages of the last frame again.
  void publish_again();

  /// Returns whether the last frame had a message that these participants answer with a command. That is a message of
  /// the topic `reply_to`, or of the subscribed topic with the longest period.
  bool asks(std::span<const Gid> participants) const;

  /// Returns the number of messages that were dropped because subscribers did not keep up.
  std::uint64_t dropped() const { return dropped_; }
  /// Returns whether all reliable subscribers have received the messages of the last frame.
  bool is_received() const;
  struct PublishedTopic {
    std::string name;  ///< name in ROS
    std::string type;
    std::uint32_t subscriptions = 0;
  };
  std::vector<PublishedTopic> published_topics() const;
  /// Returns whether the participant is announced to all subscribers.
  bool is_known_to_subscribers(const RosParticipant& participant) const;
  /// Returns whether any topic has a subscriber.
  bool has_subscribers() const;

 private:
  using Fill = std::function<void(messages::CdrWriter& to, const messages::ros::Header& header,
                                  std::span<const double> observation)>;
  struct Topic {
    std::string name;  // in the list of topics
    PublishedTopic in_ros;
    std::string frame_id;        // for the header
    PeriodicTicks measurements;  // frames with a measurement
    PeriodicTicks messages;      // measurements that are published
    Fill fill;
    RosWriter writer;
    messages::Bytes last{};   // message of the last frame; empty: none
    std::vector<Gid> told{};  // participants that have subscribed when it was published, and have not left since
    bool counts_for_reply = true;

    /// Returns whether a message is due at a frame. `before` is the previous frame.
    bool is_due(std::uint64_t frame, std::uint64_t before) const {
      return frame == 0 || messages.count(measurements.count(frame)) != messages.count(measurements.count(before));
    }
    std::chrono::nanoseconds period() const { return messages.period(); }
  };

  template <messages::RosMessage Message>
  void add(RosParticipant& participant, const std::string& name, const std::string& frame, bool counts_for_reply,
           Fill fill);
  void add(RosParticipant& participant, const std::string& name, const std::string& frame, const std::string& type,
           const std::string& type_hash, bool counts_for_reply, Fill fill, std::chrono::nanoseconds period = {});
  void send(Topic& topic);
  std::vector<SensorFrame> sensor_frames() const;
  void move(std::span<const double> observation, double seconds);
  void move_truly(const WorldPose& pose, double seconds);

  const RobotSettings settings_;
  std::function<void()> matched_;
  Drive* drive_;
  std::chrono::nanoseconds between_frames_;
  std::uint32_t period_;
  std::uint32_t phase_;
  const std::vector<messages::DeviceMessage> devices_;
  const bool tells_truth_;
  FrameTree frames_;
  std::vector<Topic> topics_;
  std::optional<RosWriter> static_frames_;
  std::optional<messages::ros::Odometry> odometry_;  // odometry at the last frame, without its header
  std::optional<std::chrono::nanoseconds> last_time_;
  std::optional<std::uint64_t> last_frame_;
  std::optional<PublishedTopic> static_topic_;
  messages::CdrWriter cdr_;
  std::uint64_t dropped_ = 0;
};

/// Converts channels to the type that the server uses.
std::vector<Channel> channels_of(const std::vector<ChannelInfo>& infos);

}  // namespace cohort::ros2
