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

/// One robot in the ROS graph: its topics, its command, and whether that answers the last frame. One thread.
class RosRobot {
 public:
  struct Options {
    RobotSettings settings;
    std::size_t first_input = 0;                        ///< number of its first topic of commands in the inbox
    std::function<void(const std::string& text)> tell;  ///< to people
    std::function<void()> changed;                      ///< called on threads of DDS when those who command it change
  };
  /// Throws std::runtime_error for settings that do not fit the robot.
  RosRobot(RosParticipant& participant, const RosGraph& graph, RosInbox& inbox, const description::Model& model,
           const DrivenRobot& robot, Options options);

  const std::string& name() const { return name_; }
  const Policy& policy() const { return policy_; }
  const RobotSettings& settings() const { return options_.settings; }
  std::size_t inputs() const { return inputs_.size(); }
  std::size_t first_input() const { return options_.first_input; }

  /// The robot begins a run, or another one: it stands.
  void begin(std::chrono::nanoseconds time);
  /// Tells subscribers of a frame, which waits for an answer from now on.
  /// `truth`: where it is, if publications() want to know.
  void tell_frame(const FrameRobot& frame, std::uint64_t tick, std::chrono::nanoseconds time,
                  const std::optional<WorldPose>& truth);
  /// Tells them once more, while the frame is not answered: those that came since, or all.
  void tell_again(bool all);
  /// Takes a message that came.
  void take(std::size_t input, std::span<const std::byte> bytes, std::uint64_t writer);
  /// Returns whether the frame has the command that it waits for.
  bool is_answered() const;
  /// Returns whether a node commands the robot.
  bool has_commander() const;
  /// Returns whether the frame may have been lost on its way to a node that has not answered before.
  bool may_be_unheard() const { return !is_commanded_ && (!has_answered_ || is_told_again_); }
  /// Returns whether a frame without a command is waited for no longer than this.
  bool is_given_up_after(std::chrono::nanoseconds waited) const;
  /// Does without a command, as `on_silence` has it.
  void go_on_unanswered(std::uint64_t tick);
  /// Sets the command that the frame is answered with.
  void answer(Command& command);
  /// Looks at who is there now: takes on types, and tells who cannot be heard, who came and who left. Returns whether
  /// its endpoints changed.
  bool follow(RosParticipant& participant, const WritersByTopic& writers);
  /// Tells of mistakes of nodes whose names have come since, or do not come.
  void tell_mistakes();

  /// Returns the participants that command it, ascending; valid until the next call.
  std::span<const Gid> commanding_participants() const;
  /// Returns who commands it, for people.
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
  bool is_commanded_ = false;         // since it was told
  bool has_answered_ = false;         // since it began
  bool is_silent_ = false;            // in the last frame
  // A frame that was published more than once may have several answers. Late nodes also receive earlier frames, as long
  // as DDS keeps them for a node that has not received them. Then the last answer counts.
  bool is_told_again_ = false;
  std::optional<std::chrono::steady_clock::time_point> unstamped_since_{};  // arrival of a command without a stamp

  void tell_commanders();
  void tell_ended_nodes();
  void note_mistake(const std::string& topic, const std::optional<RosEndpoint>& writer, const std::string& text);

  // A mistake of a node. It is told with the node's name, which comes a little later than the node's endpoints.
  struct Mistake {
    std::string topic;
    std::optional<RosEndpoint> writer;  // nothing: has gone
    std::string text;
    std::chrono::steady_clock::time_point since{};
    bool is_told = false;
  };
  std::string told_commanders_;
  std::map<Gid, std::string> commanders_;  // nodes that command it or did so, by participant, until they end
  std::vector<Mistake> mistakes_;
};

}  // namespace cohort::ros2
