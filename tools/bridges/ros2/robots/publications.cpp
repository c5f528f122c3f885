// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/robots/publications.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "idl/dds/ros2/ros_names.hpp"
#include "idl/messages/ros_navigation_messages.hpp"
#include "idl/messages/ros_type_hash.hpp"

namespace cohort::ros2 {
namespace {

namespace ros = messages::ros;
using description::RosSync;

ros::Quaternion turned_by(double heading) { return {0.0, 0.0, std::sin(0.5 * heading), std::cos(0.5 * heading)}; }

constexpr const char* odom_frame = "odom";

}  // namespace

std::vector<Channel> channels_of(const std::vector<ChannelInfo>& infos) {
  std::vector<Channel> channels;
  for (const ChannelInfo& info : infos) {
    Channel channel;
    channel.name = info.name;
    channel.size = info.size;
    channels.push_back(channel);
  }
  return channels;
}

Publications::Publications(RosParticipant& participant, const description::Model& model, const DrivenRobot& robot,
                           const RobotSettings& settings, Drive* drive, const std::function<void()>& matched)
    : settings_(settings),
      matched_(matched),
      drive_(drive != nullptr && drive->measures() ? drive : nullptr),
      between_frames_(robot.start.step * robot.policy.period),
      period_(robot.policy.period),
      phase_(robot.policy.phase),
      devices_(messages::device_messages(model, channels_of(robot.start.observation_channels))),
      tells_truth_(settings.odometry == description::RosOdometry::truth || drive_ == nullptr),
      frames_(model, robot.start, settings.base_frame, settings.frames, sensor_frames()) {
  add<ros::Odometry>(participant, "odom", odom_frame, true,
                     [this](messages::CdrWriter& to, const ros::Header& header, std::span<const double>) {
                       ros::Odometry message = *odometry_;
                       message.header = header;
                       to.add(message);
                     });
  for (const messages::DeviceMessage& device : devices_)
    add(
        participant, device.name, device.frame, device.type, messages::type_hash(device.definition), true,
        [&device](messages::CdrWriter& to, const ros::Header& header, std::span<const double> observation) {
          device.add(to, header, observation);
        },
        device.period);
  add<ros::TFMessage>(participant, "tf", "", false,
                      [this](messages::CdrWriter& to, const ros::Header& header, std::span<const double> observation) {
                        ros::TFMessage message;
                        const auto& [position, orientation] = odometry_->pose.pose;
                        message.transforms.push_back({{header.stamp, settings_.frames + odom_frame},
                                                      frames_.base(),
                                                      {{position.x, position.y, position.z}, orientation}});
                        frames_.add_moving(observation, header.stamp, message);
                        to.add(message);
                      });
  if (const std::optional<std::string> name = name_of_topic(settings_, "tf_static")) {
    static_topic_ = {*name, ros::TFMessage::type};
    static_frames_.emplace(participant, topic_endpoint(*name, ros::TFMessage::type,
                                                       messages::type_hash<ros::TFMessage>(), {true, true, 1}));
  }
}

std::vector<SensorFrame> Publications::sensor_frames() const {
  std::vector<SensorFrame> sensors;
  std::set<std::string> seen;  // several messages may have one frame
  for (const messages::DeviceMessage& device : devices_)
    if (device.place_on_link && seen.insert(device.frame).second)
      sensors.push_back({device.frame, device.place_on_link->link, device.place_on_link->X_LS});
  return sensors;
}

template <messages::RosMessage Message>
void Publications::add(RosParticipant& participant, const std::string& name, const std::string& frame,
                       bool counts_for_reply, Fill fill) {
  add(participant, name, frame, Message::type, messages::type_hash<Message>(), counts_for_reply, std::move(fill));
}

void Publications::add(RosParticipant& participant, const std::string& name, const std::string& frame,
                       const std::string& type, const std::string& type_hash, bool counts_for_reply, Fill fill,
                       std::chrono::nanoseconds period) {
  const std::optional<std::string> topic = name_of_topic(settings_, name);
  if (!topic) return;
  const PeriodicTicks measurements(period, between_frames_);
  const double rate = rate_of_topic(settings_, name);
  topics_.push_back({name,
                     {*topic, type},
                     frame.empty() ? frame : frames_.name_of(frame),
                     measurements,
                     rate > 0.0 ? PeriodicTicks::at_rate(rate, measurements.period())
                                : PeriodicTicks(measurements.period(), measurements.period()),
                     std::move(fill),
                     RosWriter(participant, topic_endpoint(*topic, type, type_hash), matched_),
                     {},
                     {},
                     counts_for_reply});
}

void Publications::move(std::span<const double> observation, double seconds) {
  const PlanarMotion& motion = drive_->measure(observation, seconds);
  odometry_->pose.pose = {{motion.x, motion.y, 0.0}, turned_by(motion.heading)};
  odometry_->twist.twist.linear.x = motion.velocity.linear;
  odometry_->twist.twist.angular.z = motion.velocity.angular;
  constexpr std::array<std::size_t, 3> places = {0, 1, 5};  // places of x, y and the heading among the six of ROS
  for (std::size_t row = 0; row < places.size(); ++row)
    for (std::size_t column = 0; column < places.size(); ++column)
      odometry_->pose.covariance[6 * places[row] + places[column]] =
          motion.covariance(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
  odometry_->twist.covariance[0] = motion.variance.linear;
  odometry_->twist.covariance[35] = motion.variance.angular;
}

// The twist is what carried the robot here from where it was in the last frame, in the axes of its frame there.
void Publications::move_truly(const WorldPose& pose, double seconds) {
  const auto& [position, orientation] = pose;
  const Eigen::Vector3d now(position.x, position.y, position.z);
  const Eigen::Quaterniond turned(orientation.w, orientation.x, orientation.y, orientation.z);
  const ros::Pose before = odometry_->pose.pose;
  odometry_->pose.pose = {{now.x(), now.y(), now.z()}, {orientation.x, orientation.y, orientation.z, orientation.w}};
  odometry_->twist.twist = {};
  if (seconds <= 0.0) return;
  const Eigen::Quaterniond inverse =
      Eigen::Quaterniond(before.orientation.w, before.orientation.x, before.orientation.y, before.orientation.z)
          .conjugate();
  const Eigen::Vector3d way =
      inverse * (now - Eigen::Vector3d(before.position.x, before.position.y, before.position.z)) / seconds;
  const Eigen::AngleAxisd turn(inverse * turned);
  const Eigen::Vector3d rate = turn.angle() / seconds * turn.axis();
  odometry_->twist.twist = {{way.x(), way.y(), way.z()}, {rate.x(), rate.y(), rate.z()}};
}

void Publications::begin(std::chrono::nanoseconds time) {
  last_time_.reset();
  last_frame_.reset();
  odometry_.emplace();
  odometry_->child_frame_id = frames_.base();
  if (drive_ != nullptr) drive_->restart();
  if (!static_frames_) return;
  static_frames_->write(messages::encode(frames_.fixed(ros::time(time))));
}

void Publications::follow(std::span<const double> observation, std::chrono::nanoseconds time,
                          const std::optional<WorldPose>& truth) {
  const double seconds = last_time_ ? std::chrono::duration<double>(time - *last_time_).count() : 0.0;
  last_time_ = time;
  if (truth)
    move_truly(*truth, seconds);
  else if (drive_ != nullptr)
    move(observation, seconds);
}

void Publications::publish(std::span<const double> observation, std::uint64_t tick, std::chrono::nanoseconds time,
                           const std::optional<WorldPose>& truth) {
  follow(observation, time, truth);
  const ros::Time stamp = ros::time(time);
  const std::uint64_t frame = (tick - phase_) / period_;
  const std::uint64_t before = std::exchange(last_frame_, frame).value_or(frame == 0 ? 0 : frame - 1);
  for (Topic& topic : topics_) {
    topic.last.clear();
    topic.told.clear();
    if (!topic.is_due(frame, before)) continue;
    // Queries for published messages need it, even without a subscriber.
    if (settings_.sync == RosSync::free && topic.writer.readers() == 0) continue;
    cdr_.clear();
    topic.fill(cdr_, {stamp, topic.frame_id}, observation);
    topic.last = cdr_.bytes();
    send(topic);
  }
}

void Publications::send(Topic& topic) {
  if (topic.last.empty()) return;
  if (settings_.sync != RosSync::free) {
    const std::span<const Gid> told = topic.writer.participants();
    topic.told.assign(told.begin(), told.end());
  }
  if (!topic.writer.write(topic.last)) ++dropped_;
}

bool Publications::publish_to_newcomers(std::span<const Gid> participants) {
  bool has_told = false;
  for (Topic& topic : topics_) {
    const std::span<const Gid> subscribed = topic.writer.participants();
    std::erase_if(topic.told, [&](const Gid& each) { return !std::ranges::binary_search(subscribed, each); });
    const auto is_newcomer = [&](const Gid& each) {
      return std::ranges::binary_search(participants, each) && !std::ranges::binary_search(topic.told, each);
    };
    if (topic.last.empty() || std::ranges::none_of(subscribed, is_newcomer)) continue;
    send(topic);
    has_told = true;
  }
  return has_told;
}

void Publications::publish_again() {
  for (Topic& topic : topics_) send(topic);
}

bool Publications::asks(std::span<const Gid> participants) const {
  const Topic* asking = nullptr;
  for (const Topic& topic : topics_) {
    if (!settings_.reply_to.empty()) {
      if (topic.name == settings_.reply_to) return !topic.last.empty();
      continue;
    }
    if (!topic.counts_for_reply) continue;
    const auto is_theirs = [&](const Gid& each) { return std::ranges::binary_search(participants, each); };
    if (std::ranges::none_of(topic.writer.participants(), is_theirs)) continue;
    if (asking == nullptr || topic.period() > asking->period()) asking = &topic;
  }
  return asking == nullptr || !asking->last.empty();
}

bool Publications::is_received() const {
  return std::ranges::all_of(topics_, [](const Topic& topic) {
    return topic.last.empty() || topic.writer.readers() == 0 || topic.writer.is_received();
  });
}

std::vector<Publications::PublishedTopic> Publications::published_topics() const {
  std::vector<PublishedTopic> all;
  for (const Topic& topic : topics_) {
    all.push_back(topic.in_ros);
    all.back().subscriptions = topic.writer.readers();
  }
  if (static_topic_) {
    all.push_back(*static_topic_);
    all.back().subscriptions = static_frames_->readers();
  }
  return all;
}

bool Publications::is_known_to_subscribers(const RosParticipant& participant) const {
  const auto is_known = [&](const RosWriter& writer) { return participant.is_announced_to(writer.participants()); };
  return (!static_frames_ || is_known(*static_frames_)) &&
         std::ranges::all_of(topics_, [&](const Topic& topic) { return is_known(topic.writer); });
}

bool Publications::has_subscribers() const {
  return std::ranges::any_of(topics_, [](const Topic& topic) { return topic.writer.readers() > 0; });
}

}  // namespace cohort::ros2
