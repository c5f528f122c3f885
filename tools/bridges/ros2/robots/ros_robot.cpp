// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/robots/ros_robot.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "idl/dds/ros2/ros_names.hpp"

namespace cohort::ros2 {

RosRobot::RosRobot(RosParticipant& participant, const RosGraph& graph, RosInbox& inbox, const description::Model& model,
                   const DrivenRobot& robot, Options options)
    : graph_(graph),
      options_(std::move(options)),
      name_(robot.start.name),
      policy_(robot.policy),
      drive_(Drive::of(model, robot.start, options_.settings.drive)) {
  Drive* const drive = drive_ ? &*drive_ : nullptr;
  inputs_ = command_topics(model, robot, options_.settings, drive);
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    inputs_[i].open(
        participant,
        [&inbox, input = options_.first_input + i](const Received& received) {
          inbox.put({input, {received.bytes.begin(), received.bytes.end()}, received.writer});
        },
        options_.changed);
  publications_ =
      std::make_unique<Publications>(participant, model, robot, options_.settings, drive, [&inbox] { inbox.wake(); });
  for (const ChannelInfo& channel : robot.start.command_channels) {
    channels_.push_back({channel.offset, channel.size, channel.lower, channel.upper});
    neutral_.insert(neutral_.end(), channel.size, channel.neutral);
  }
  command_ = neutral_;
}

void RosRobot::begin(std::chrono::nanoseconds time) {
  for (const CommandTopic& input : inputs_) input.end();
  command_ = neutral_;
  has_answered_ = false;
  publications_->begin(time);
}

void RosRobot::tell_frame(const FrameRobot& frame, std::uint64_t tick, std::chrono::nanoseconds time,
                          const std::optional<WorldPose>& truth) {
  time_ = time;
  is_commanded_ = is_told_again_ = false;
  std::uint32_t size = 0;
  for (const ChannelInfo& channel : frame.robot->start.observation_channels) size += channel.size;
  publications_->publish(frame.observation.values({0, size}), tick, time, truth);
}

void RosRobot::tell_again(bool all) {
  if (all)
    publications_->publish_again();
  else if (inputs_.empty() || !publications_->publish_to_newcomers(inputs_.front().participants()))
    return;
  is_told_again_ = true;
}

void RosRobot::take(std::size_t input, std::span<const std::byte> bytes, std::uint64_t writer) {
  try {
    const Stamp stamp = inputs_[input].take(bytes, command_);
    // The first topic is the one that moves the robot.
    if (input != 0 || (stamp && *stamp < time_)) return;
    is_commanded_ = has_answered_ = true;
    unstamped_since_ = stamp ? std::nullopt : std::optional(std::chrono::steady_clock::now());
    is_silent_ = false;
  } catch (const std::exception& error) {
    note_mistake(inputs_[input].name(), graph_.endpoint(writer),
                 std::string(": ") + error.what() + "; this message is ignored");
  }
}

// Names of nodes come a little later than their endpoints.
void RosRobot::tell_commanders() {
  if (!inputs_.empty() && !std::ranges::all_of(inputs_.front().participants(),
                                               [&](const Gid& each) { return graph_.knows_nodes_of(each); }))
    return;
  for (const Gid& each : commanding_participants()) commanders_[each] = graph_.nodes_of(each);
  const std::string now = commanders();
  if (now == told_commanders_) return;
  options_.tell(now.empty() ? told_commanders_ + " no longer commands it" : now + " commands it");
  told_commanders_ = now;
}

void RosRobot::tell_ended_nodes() {
  std::erase_if(commanders_, [&](const auto& each) {
    if (graph_.has(each.first)) return false;
    options_.tell(each.second + " has ended");
    return true;
  });
}

// Each is told once.
void RosRobot::note_mistake(const std::string& topic, const std::optional<RosEndpoint>& writer,
                            const std::string& text) {
  constexpr std::size_t most_mistakes = 100;
  const auto is_same = [&](const Mistake& each) {
    return each.topic == topic && each.text == text && each.writer.has_value() == writer.has_value() &&
           (!writer || each.writer->participant == writer->participant);
  };
  if (mistakes_.size() >= most_mistakes || std::ranges::any_of(mistakes_, is_same)) return;
  mistakes_.push_back({topic, writer, text, std::chrono::steady_clock::now()});
  tell_mistakes();
}

void RosRobot::tell_mistakes() {
  constexpr std::chrono::seconds longest_wait{5};  // Fast DDS tells a newcomer of names within 3 s
  for (Mistake& mistake : mistakes_) {
    if (mistake.is_told) continue;
    const auto& writer = mistake.writer;
    if (writer && !graph_.knows_nodes_of(writer->participant) &&
        std::chrono::steady_clock::now() < mistake.since + longest_wait)
      continue;
    mistake.is_told = true;
    options_.tell(mistake.topic + " from " + (writer ? graph_.nodes_of(writer->participant) : "a node that has left") +
                  mistake.text);
  }
}

std::span<const Gid> RosRobot::commanding_participants() const {
  return inputs_.empty() ? std::span<const Gid>() : inputs_.front().participants();
}

bool RosRobot::has_commander() const { return !commanding_participants().empty(); }

bool RosRobot::is_answered() const {
  if (options_.settings.sync != description::RosSync::command || inputs_.empty()) return true;
  constexpr std::chrono::milliseconds longest_between_answers{200};
  if (is_commanded_)
    return !is_told_again_ || !unstamped_since_ ||
           std::chrono::steady_clock::now() >= *unstamped_since_ + longest_between_answers;
  return has_commander() && !publications_->asks(inputs_.front().participants());
}

bool RosRobot::is_given_up_after(std::chrono::nanoseconds waited) const {
  const RobotSettings& settings = options_.settings;
  return settings.on_silence != description::RosOnSilence::wait && settings.wait && waited > *settings.wait;
}

void RosRobot::go_on_unanswered(std::uint64_t tick) {
  if (is_commanded_) return;
  const bool stands = options_.settings.on_silence == description::RosOnSilence::stand;
  if (stands) command_ = neutral_;
  if (std::exchange(is_silent_, true)) return;
  const std::string who = commanders();
  options_.tell("no " + command_topic() + (who.empty() ? "" : " from " + who) + " for tick " + std::to_string(tick) +
                ": the robot " + (stands ? "stands" : "keeps its last command") + " until a command arrives");
}

void RosRobot::answer(Command& command) {
  for (const CommandTopic& input : inputs_) input.advance(time_, command_);
  for (const CommandChannel& channel : channels_)
    for (std::size_t i = 0; i < channel.size; ++i) command.set(channel, command_[channel.offset + i], i);
}

std::string RosRobot::commanders() const {
  std::string text;
  if (inputs_.empty()) return text;
  for (const Gid& participant : inputs_.front().participants())
    text += (text.empty() ? "" : " and ") + graph_.nodes_of(participant);
  return text;
}

const std::string& RosRobot::command_topic() const {
  static const std::string none;
  return inputs_.empty() ? none : inputs_.front().name();
}

bool RosRobot::follow(RosParticipant& participant, const WritersByTopic& writers) {
  bool has_changed = false;
  for (CommandTopic& input : inputs_) {
    const auto found = writers.find(dds_topic(TopicKind::message, input.name()));
    if (found == writers.end()) continue;
    has_changed |= input.follow(participant, found->second);
    for (const RosEndpoint& writer : found->second)
      if (const std::string why = input.why_not(writer); !why.empty()) note_mistake(input.name(), writer, " " + why);
  }
  tell_commanders();
  tell_ended_nodes();
  return has_changed;
}

}  // namespace cohort::ros2
