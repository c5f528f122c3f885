// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/replayed_robots.hpp"

#include <algorithm>
#include <utility>

#include "idl/dds/ros2/ros_names.hpp"
#include "idl/messages/ros_geometry_messages.hpp"
#include "server/description/select_robots.hpp"
#include "server/messages/device_messages.hpp"

namespace cohort::tool {
namespace {

namespace ros = messages::ros;
using recording::ChannelId;

recording::Roster roster_of(const recording::McapReader& reader) {
  recording::MessageStream stream = reader.messages({.channels = {reader.channel(recording::Roster::topic)->id}});
  const auto message = stream.next();
  return message ? messages::decode<recording::Roster>(message->data) : recording::Roster{};
}

std::vector<ChannelInfo> with_offsets(const std::vector<recording::RecordedChannel>& channels) {
  std::vector<ChannelInfo> infos;
  std::uint32_t offset = 0;
  for (const recording::RecordedChannel& channel : channels) {
    ChannelInfo& info = infos.emplace_back();
    info.name = channel.name;
    info.unit = channel.unit;
    info.size = channel.size;
    info.offset = std::exchange(offset, offset + channel.size);
  }
  return infos;
}

}  // namespace

ReplayedRobots::ReplayedRobots(ros2::RosParticipant& participant, const std::filesystem::path& file,
                               const std::set<std::string>& recorded) {
  const recording::Recording recording(file);
  const recording::McapReader& reader = recording.reader();
  if (reader.channel(recording::Roster::topic) == nullptr) return;
  const recording::Roster roster = roster_of(reader);
  const description::Experiment experiment = recording.experiment(recording.worlds().front());
  for (const std::uint32_t robot : description::select_robots_of_any(experiment.world, experiment.ros2.robots)) {
    const recording::Channel* const channel =
        reader.channel("/" + experiment.world.robot(robot).name + recording::observation_topic_end);
    if (channel == nullptr || robot >= roster.robots.size()) continue;
    auto added = make_robot(participant, experiment, roster, robot, recorded);
    if (added->publications->wants_true_pose() && !poses_)
      if (const recording::Channel* const poses = reader.channel("/tf")) poses_ = poses->id;
    channels_.push_back(channel->id);
    robots_.emplace(channel->id, std::move(added));
  }
  if (poses_) channels_.push_back(*poses_);
}

std::unique_ptr<ReplayedRobots::Robot> ReplayedRobots::make_robot(ros2::RosParticipant& participant,
                                                                  const description::Experiment& experiment,
                                                                  const recording::Roster& roster, std::uint32_t robot,
                                                                  const std::set<std::string>& recorded) {
  const recording::RecordedRobot& as_recorded = roster.robots[robot];
  const recording::RecordedKind& kind = roster.kinds.at(as_recorded.kind);
  DrivenRobot driven;
  driven.start.robot = robot;
  driven.start.name = as_recorded.name;
  driven.start.model = kind.model;
  driven.start.team = as_recorded.team;
  driven.start.step = experiment.world.step;
  driven.start.observation_channels = with_offsets(kind.observation);
  driven.start.command_channels = with_offsets(kind.command);
  const auto team = std::ranges::find(experiment.teams, as_recorded.team, &description::Team::name);
  if (team != experiment.teams.end()) {
    driven.policy.period = team->policy.period;
    driven.policy.phase = team->policy.phase;
  }
  const description::Model& model = experiment.world.robot_model(robot);
  ros2::RobotSettings settings = experiment.ros2.of_team(as_recorded.team);
  settings.sync = description::RosSync::free;
  if (settings.name_space.empty()) settings.name_space = ros2::absolute_name(as_recorded.name);
  for (const messages::DeviceMessage& device :
       messages::device_messages(model, ros2::channels_of(driven.start.observation_channels)))
    if (const auto name = ros2::name_of_topic(settings, device.name); name && recorded.contains(*name))
      settings.topics.push_back({device.name, false, {}, {}});

  auto made = std::make_unique<Robot>();
  made->name = as_recorded.name;
  made->step = experiment.world.step;
  made->drive = ros2::Drive::of(model, driven.start, settings.drive);
  made->publications = std::make_unique<ros2::Publications>(participant, model, driven, settings,
                                                            made->drive ? &*made->drive : nullptr, [] {});
  return made;
}

void ReplayedRobots::restart() {
  pose_of_.clear();
  for (auto& [channel, robot] : robots_) robot->time.reset();
}

void ReplayedRobots::take(const recording::Message& message, bool is_published) {
  if (const auto found = robots_.find(message.channel); found != robots_.end())
    return observe(*found->second, message.data, is_published);
  if (message.channel != poses_) return;
  for (const ros::TransformStamped& each : messages::decode<ros::TFMessage>(message.data).transforms) {
    if (each.header.frame_id != "world") continue;
    const auto& [translation, rotation] = each.transform;
    pose_of_[each.child_frame_id] = {{translation.x, translation.y, translation.z},
                                     {rotation.x, rotation.y, rotation.z, rotation.w}};
  }
}

// An observation is its time and one number for each value.
void ReplayedRobots::observe(Robot& robot, recording::ByteView bytes, bool is_published) {
  messages::CdrReader reader(bytes);
  const auto stamp = reader.get<ros::Time>();
  std::vector<double> values;
  while (reader.left() >= sizeof(double)) values.push_back(reader.get<double>());
  const std::chrono::nanoseconds time = std::chrono::seconds(stamp.sec) + std::chrono::nanoseconds(stamp.nanosec);
  if (!robot.time || time <= *robot.time) robot.publications->begin(time);
  robot.time = time;
  std::optional<WorldPose> truth;
  if (robot.publications->wants_true_pose()) {
    const auto found = pose_of_.find(robot.name);
    if (found == pose_of_.end()) return;  // no poses are recorded
    truth = found->second;
  }
  if (is_published)
    robot.publications->publish(values, static_cast<std::uint64_t>(time / robot.step), time, truth);
  else
    robot.publications->follow(values, time, truth);
}

std::vector<ros2::Publications::PublishedTopic> ReplayedRobots::topics() const {
  std::vector<ros2::Publications::PublishedTopic> all;
  for (const auto& [channel, robot] : robots_)
    for (ros2::Publications::PublishedTopic& topic : robot->publications->published_topics())
      all.push_back(std::move(topic));
  return all;
}

std::uint64_t ReplayedRobots::dropped() const {
  std::uint64_t sum = 0;
  for (const auto& [channel, robot] : robots_) sum += robot->publications->dropped();
  return sum;
}

bool ReplayedRobots::is_known_to_subscribers(const ros2::RosParticipant& participant) const {
  return std::ranges::all_of(
      robots_, [&](const auto& each) { return each.second->publications->is_known_to_subscribers(participant); });
}

bool ReplayedRobots::is_received() const {
  return std::ranges::all_of(robots_, [](const auto& each) { return each.second->publications->is_received(); });
}

}  // namespace cohort::tool
