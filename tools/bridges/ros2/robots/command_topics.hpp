// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/include/cohort/client.hpp"
#include "idl/dds/ros2/ros_graph.hpp"
#include "idl/dds/ros2/ros_participant.hpp"
#include "idl/messages/cdr.hpp"
#include "server/description/model.hpp"
#include "tools/bridges/ros2/robots/drive.hpp"
#include "tools/bridges/ros2/robots/settings.hpp"

namespace cohort::ros2 {

/// The time for which a command message was meant, if the message has a stamp.
using Stamp = std::optional<std::chrono::nanoseconds>;

/// The writers of other participants, by DDS topic.
using WritersByTopic = std::map<std::string, std::vector<RosEndpoint>>;

/// A topic that commands a robot. It may have one of several types: that of its publisher.
class CommandTopic {
 public:
  struct Type {
    std::string name;
    std::string hash;
    /// Changes the robot's command according to a message. Throws messages::CdrError, or std::invalid_argument that
    /// says what is wrong in the message; the command is then unchanged.
    std::function<Stamp(messages::CdrReader& message, std::span<double> command)> take;
  };
  /// A command that takes time, such as a trajectory.
  struct Motion {
    std::function<void(std::chrono::nanoseconds time, std::span<double> command)> advance;
    std::function<void()> end;  ///< ends the present command
  };
  /// `name` is absolute. The first of `types` is used while there is no publisher. `motion` is for commands that take
  /// time.
  CommandTopic(std::string name, std::vector<Type> types, Motion motion = Motion());

  const std::string& name() const { return name_; }

  /// Receives messages from now on.
  void open(RosParticipant& participant, std::function<void(const Received&)> received, std::function<void()> matched);
  /// Adopts the type and reliability of a publisher of the topic, if no publisher is matched. Returns whether they have
  /// changed.
  bool follow(RosParticipant& participant, const std::vector<RosEndpoint>& writers);
  /// Returns why messages of this writer can never be received; empty if they can.
  std::string why_not(const RosEndpoint& writer) const;

  /// Changes the robot's command as Type::take does.
  Stamp take(std::span<const std::byte> message, std::span<double> command) const;

  /// Sets the command for this time, if a command that takes time is in progress.
  void advance(std::chrono::nanoseconds time, std::span<double> command) const {
    if (motion_.advance) motion_.advance(time, command);
  }
  /// Ends a command that takes time.
  void end() const {
    if (motion_.end) motion_.end();
  }

  /// Returns the participants that publish this topic, in ascending order.
  std::span<const Gid> participants() const { return reader_->participants(); }

 private:
  void read(RosParticipant& participant);

  std::string name_;
  std::vector<Type> types_;
  Motion motion_;
  std::size_t type_ = 0;
  bool is_reliable_ = true;
  std::function<void(const Received&)> received_;
  std::function<void()> matched_;
  std::optional<RosReader> reader_;
};

/// Returns the topics that command a robot: `cmd_vel` if it has a drive, then those of its joints, then those of its
/// other devices. `drive` may be nullptr, and must outlive them.
std::vector<CommandTopic> command_topics(const description::Model& model, const DrivenRobot& robot,
                                         const RobotSettings& settings, const Drive* drive);

}  // namespace cohort::ros2
