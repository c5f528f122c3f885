// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client_sdk/include/cohort/client.hpp"
#include "idl/dds/ros2/ros_graph.hpp"
#include "tools/bridges/ros2/robots/command_topics.hpp"
#include "tools/bridges/ros2/robots/publications.hpp"
#include "tools/bridges/ros2/robots/ros_inbox.hpp"

namespace cohort::ros2 {

/// One robot in the ROS graph: its topics, its command, and whether the last frame is answered. Not thread-safe.
class RosRobot {
 public:
  struct Options {
    RobotSettings settings;
    std::size_t first_input = 0;                        ///< number of its first command topic in the inbox
    std::function<void(const std::string& text)> tell;  ///< reports to the user
    std::function<void()> changed;                      ///< called on DDS threads when the command publishers change
  };
  /// Throws std::runtime_error for settings that do not fit the robot.
  RosRobot(RosParticipant& participant, const RosGraph& graph, RosInbox& inbox, const description::Model& model,
           const DrivenRobot& robot, Options options);

  const std::string& name() const { return name_; }
  const Policy& policy() const { return policy_; }
  const RobotSettings& settings() const { return options_.settings; }
  std::size_t inputs() const { return inputs_.size(); }
  std::size_t first_input() const { return options_.first_input; }

  /// Begins a run, or another one, with the neutral command.
  void begin(std::chrono::nanoseconds time);
  /// Publishes a frame, which waits for an answer from now on. `truth` is the robot's true pose, if publications() want
  /// it.
  void tell_frame(const FrameRobot& frame, std::uint64_t tick, std::chrono::nanoseconds time,
                  const std::optional<WorldPose>& truth);
  /// Publishes the frame again while it is not answered: for new subscribers, or for all.
  void tell_again(bool all);
  /// Handles a message that has arrived on a command topic.
  void take(std::size_t input, std::span<const std::byte> bytes, std::uint64_t writer);
  /// Returns whether the command for the frame has arrived, or none is awaited.
  bool is_answered() const;
  /// Returns whether a node commands the robot.
  bool has_commander() const;
  /// Returns whether the frame may have been lost on its way to a node that has not answered before.
  bool may_be_unheard() const { return !is_commanded_ && (!has_answered_ || is_told_again_); }
  /// Returns whether the bridge stops waiting for a command after this time.
  bool is_given_up_after(std::chrono::nanoseconds waited) const;
  /// Continues without a command, as `on_silence` says.
  void go_on_unanswered(std::uint64_t tick);
  /// Sets the command with which the frame is answered.
  void answer(Command& command);
  /// Follows changes in the ROS graph: adopts the publishers' types, and reports publishers that came, left, or cannot
  /// be received. Returns whether the robot's endpoints have changed.
  bool follow(RosParticipant& participant, const WritersByTopic& writers);
  /// Reports the errors of nodes whose names have become known, or did not become known in time.
  void tell_mistakes();

  /// Returns the participants that command the robot, in ascending order; valid until the next call.
  std::span<const Gid> commanding_participants() const;
  /// Returns the nodes that command the robot, for messages to the user.
  std::string commanders() const;
  const std::string& command_topic() const;
  Publications& publications() { return *publications_; }

 private:
  const RosGraph& graph_;
  Options options_;
  std::string name_;
  Policy policy_;
  std::optional<Drive> drive_;
  std::vector<CommandTopic> inputs_;
  std::unique_ptr<Publications> publications_;
  std::vector<CommandChannel> channels_;
  std::vector<double> neutral_;
  std::vector<double> command_;
  std::chrono::nanoseconds time_{0};  // time of the frame
  bool is_commanded_ = false;         // since the frame was published
  bool has_answered_ = false;         // since the run began
  bool is_silent_ = false;            // in the last frame
  // A frame that was published more than once may get several answers; the last one counts. Nodes that join late also
  // receive earlier frames, as long as DDS keeps these for a node that has not received them.
  bool is_told_again_ = false;
  std::optional<std::chrono::steady_clock::time_point> unstamped_since_{};  // arrival of a command without a stamp

  void tell_commanders();
  void tell_ended_nodes();
  void note_mistake(const std::string& topic, const std::optional<RosEndpoint>& writer, const std::string& text);

  // An error of a node. It is reported with the node's name, which becomes known a little later than the node's
  // endpoints.
  struct Mistake {
    std::string topic;
    std::optional<RosEndpoint> writer;  // nullopt: it has left
    std::string text;
    std::chrono::steady_clock::time_point since{};
    bool is_told = false;
  };
  std::string told_commanders_;
  std::map<Gid, std::string> commanders_;  // nodes that command it or have commanded it, by participant, until they end
  std::vector<Mistake> mistakes_;
};

}  // namespace cohort::ros2
