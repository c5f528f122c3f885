// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/ros2_playback.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "idl/dds/ros2/ros_graph.hpp"
#include "idl/dds/ros2/ros_names.hpp"
#include "idl/dds/ros2/ros_participant.hpp"
#include "server/recording/rosbag2_metadata.hpp"
#include "tools/cli/commands/replayed_robots.hpp"
#include "tools/cli/common/exit_codes.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/cli/common/terminal/replay_progress.hpp"
#include "tools/cli/common/wording.hpp"

namespace cohort::tool {
namespace {

using recording::ChannelId;
using recording::Timestamp;
using namespace std::chrono_literals;
using WallClock = std::chrono::steady_clock;

constexpr auto looked_every = 20ms;     // interval of checking for a stop and new subscribers
constexpr auto received_within = 5s;    // time limit for receiving the last messages
constexpr auto told_after = 2s;         // delay before a message names the missing subscriptions
constexpr std::int32_t kept = 1000;     // queued messages of a topic for slow subscribers
constexpr std::size_t most_lines = 20;  // printed topics
constexpr double longest_pause = 1e9;   // [s]
constexpr std::string_view own_topics = "/cohort/";
constexpr std::string_view clock_topic = "/clock";

bool is_for_nodes(const recording::Channel& channel, const recording::Schema& schema) {
  const bool is_observation = schema.name.starts_with("cohort_msgs/msg/") && schema.name.ends_with("Observation");
  return schema.encoding == "ros2msg" && channel.message_encoding == "cdr" && !is_observation &&
         !channel.topic.starts_with(own_topics);
}

// Returns whether rosbag2's metadata of the channel, by number or by name, says that it is transient local.
bool is_latched(const recording::Channel& channel) {
  const auto qos = channel.metadata.find("offered_qos_profiles");
  return qos != channel.metadata.end() && (qos->second.find("durability: 1\n") != std::string::npos ||
                                           qos->second.find("durability: transient_local") != std::string::npos);
}

// One playback, from the creation of its node to its end.
class Player {
 public:
  Player(const Ros2Playback& playback, const recording::McapReader& reader, Log& log, const std::atomic<bool>& stop)
      : playback_(playback),
        reader_(reader),
        log_(log),
        stop_(stop),
        participant_(node_of(playback)),
        graph_(participant_, [this] { graph_has_changed_ = true; }) {
    for (const auto& [id, channel] : reader.channels()) {
      const auto schema = reader.schemas().find(channel.schema);
      if (schema == reader.schemas().end() || !is_for_nodes(channel, schema->second)) continue;
      const ros2::EndpointQos qos{true, is_latched(channel), kept};
      writers_.emplace(id, ros2::RosWriter(participant_,
                                           ros2::topic_endpoint(ros2::absolute_name(channel.topic), schema->second.name,
                                                                recording::channel_type_hash(reader, channel), qos)));
      if (qos.is_transient_local) latched_.push_back(id);
    }
    if (writers_.empty())
      throw std::invalid_argument(
          fmt::format("{} has no messages for ROS 2 nodes; 'cohort run --record FILE --record-observations HZ' records "
                      "sensor readings",
                      playback.file.string()));
    add_robots();
    look_at_graph();
  }

  int run() {
    if (!playback_.quiet) tell_topics();
    wait_for_subscriptions();
    do play_once();
    while (playback_.loops && !stop_);
    log_.clear_progress();
    wait_until_received();
    if (!playback_.quiet) show(fmt::format("played {}\n", counted(played_, "message")));
    if (const std::uint64_t dropped = dropped_ + (robots_ ? robots_->dropped() : 0); dropped > 0)
      log_.warning(fmt::format("{} did not reach all subscribers, which were too slow; use a lower --speed",
                               counted(dropped, "message")),
                   {{"dropped", dropped}});
    return stop_ ? exit_interrupted : exit_ok;
  }

 private:
  // Adds the topics of the bridge, unless it is a recording of others.
  void add_robots() {
    if (reader_.channel(recording::Roster::topic) == nullptr) return;
    std::set<std::string> recorded;
    for (const auto& [id, writer] : writers_) recorded.insert(ros2::absolute_name(reader_.channels().at(id).topic));
    try {
      robots_.emplace(participant_, playback_.file, recorded);
    } catch (const std::runtime_error& error) {
      log_.warning(fmt::format("odometry and transforms are not played: {}", error.what()));
    }
  }

  static ros2::RosParticipant::Options node_of(const Ros2Playback& playback) {
    ros2::RosParticipant::Options options{ros2::RosDomain::from_environment(), "/", "cohort_replay"};
    if (playback.domain) options.domain.number = static_cast<std::uint32_t>(*playback.domain);
    return options;
  }

  // Announces this node, and announces it again if other nodes use another format.
  void look_at_graph() {
    if (is_announced_ && !graph_has_changed_.exchange(false)) return;
    const ros2::GidFormat format = graph_.gid_format().value_or(format_);
    if (is_announced_ && format == format_) return;
    format_ = format;
    is_announced_ = true;
    participant_.announce(format_);
  }

  void tell_topics() const {
    std::map<std::string, std::string> types;  // by topic
    for (const auto& [id, writer] : writers_) {
      const recording::Channel& channel = reader_.channels().at(id);
      types[ros2::absolute_name(channel.topic)] = reader_.schemas().at(channel.schema).name;
    }
    if (robots_)
      for (const auto& topic : robots_->topics()) types[topic.name] = topic.type;
    show(fmt::format("playing {} to ROS 2 nodes in domain {}\n", counted(types.size(), "topic"),
                     node_of(playback_).domain.number));
    std::size_t lines = 0;
    for (const auto& [name, type] : types)
      if (++lines <= most_lines) show(fmt::format("  {}  {}\n", name, type));
    if (types.size() > most_lines) show(fmt::format("  and {} more\n", types.size() - most_lines));
    flush_output();
  }

  // A subscription counts once, although two writers may have its topic.
  std::uint64_t subscriptions() const {
    std::map<std::string, std::uint64_t> counts;  // by topic
    for (const auto& [id, writer] : writers_)
      counts[ros2::absolute_name(reader_.channels().at(id).topic)] = writer.readers();
    if (robots_)
      for (const auto& topic : robots_->topics()) counts[topic.name] = topic.subscriptions;
    std::uint64_t sum = 0;
    for (const auto& [topic, count] : counts) sum += count;
    return sum;
  }

  bool is_known_to_subscribers() const {
    if (robots_ && !robots_->is_known_to_subscribers(participant_)) return false;
    return std::ranges::all_of(
        writers_, [&](const auto& each) { return participant_.is_announced_to(each.second.participants()); });
  }

  // A node that has received the announcement of this node knows its topics, and loses no message from then on.
  void wait_for_subscriptions() {
    const auto since = WallClock::now();
    bool is_told = false;
    while (!stop_ && playback_.awaited > 0 && (subscriptions() < playback_.awaited || !is_known_to_subscribers())) {
      look_at_graph();
      if (!is_told && WallClock::now() - since > told_after) {
        log_.notice(
            fmt::format("waiting for {}; there are {}", counted(playback_.awaited, "subscription"), subscriptions()));
        is_told = true;
      }
      std::this_thread::sleep_for(looked_every);
    }
  }

  void play_once() {
    recording::MessageQuery query;
    for (const auto& [id, writer] : writers_) query.channels.push_back(id);
    query.from = Timestamp(start_of_part(playback_.part).count());
    query.to = Timestamp(end_of_part(playback_.part).count());
    if (robots_) {
      const auto& channels = robots_->channels();
      query.channels.insert(query.channels.end(), channels.begin(), channels.end());
      std::ranges::sort(query.channels);
      query.channels.erase(std::ranges::unique(query.channels).begin(), query.channels.end());
      follow_robots_before(query.from);
    }
    play_latched_before(query.from);
    ReplayProgress progress(log_);
    first_.reset();
    recording::MessageStream messages = reader_.messages(query);
    while (const auto message = messages.next()) {
      if (first_ && message->log_time != last_) play_clock();
      if (!wait_for_time(message->log_time)) return;
      if (!playback_.quiet) progress.at(message->log_time, "played");
      if (reader_.channels().at(message->channel).topic == clock_topic)
        clock_.emplace_back(message->channel, recording::Bytes(message->data.begin(), message->data.end()));
      else if (writers_.contains(message->channel))
        write(message->channel, message->data);
      if (robots_) robots_->publish(*message);
    }
    play_clock();
    if (!first_) throw std::invalid_argument(nothing_in_part);
  }

  // Messages that late subscribers also receive, such as /tf_static, are needed wherever the part begins.
  void play_latched_before(Timestamp begin) {
    if (latched_.empty() || begin == Timestamp(0)) return;
    recording::MessageStream messages = reader_.messages({.channels = latched_, .to = begin - Timestamp(1)});
    while (const auto message = messages.next()) write(message->channel, message->data);
  }

  // Odometry is relative to the initial pose.
  void follow_robots_before(Timestamp begin) {
    robots_->restart();
    if (robots_->channels().empty() || begin == Timestamp(0)) return;
    recording::MessageStream messages = reader_.messages({.channels = robots_->channels(), .to = begin - Timestamp(1)});
    while (const auto message = messages.next()) robots_->follow(*message);
  }

  // Nodes that follow the clock receive the measurements of a time before the clock reaches that time.
  void play_clock() {
    for (const auto& [channel, bytes] : clock_) write(channel, bytes);
    clock_.clear();
  }

  // Waits. Returns false if it was stopped.
  bool wait_for_time(Timestamp time) {
    if (!first_) {
      first_ = time;
      begun_ = WallClock::now();
    }
    last_ = time;
    const double ahead = std::chrono::duration<double>(time - *first_).count();
    const double pause = playback_.speed > 0.0 ? std::min(ahead / playback_.speed, longest_pause) : 0.0;
    const auto due = begun_ + nanoseconds(pause);
    do {
      look_at_graph();
      const auto now = WallClock::now();
      if (now < due) std::this_thread::sleep_until(std::min<WallClock::time_point>(due, now + looked_every));
    } while (!stop_ && WallClock::now() < due);
    return !stop_;
  }

  void write(ChannelId channel, recording::ByteView bytes) {
    ++played_;
    if (!writers_.at(channel).write(bytes)) ++dropped_;
  }

  void wait_until_received() const {
    const auto until = WallClock::now() + received_within;
    for (const auto& [id, writer] : writers_)
      while (!stop_ && !writer.is_received() && WallClock::now() < until) std::this_thread::sleep_for(looked_every);
    while (robots_ && !stop_ && !robots_->is_received() && WallClock::now() < until)
      std::this_thread::sleep_for(looked_every);
  }

  const Ros2Playback& playback_;
  const recording::McapReader& reader_;
  Log& log_;
  const std::atomic<bool>& stop_;
  std::atomic<bool> graph_has_changed_{false};
  ros2::RosParticipant participant_;
  ros2::RosGraph graph_;
  ros2::GidFormat format_ = ros2::GidFormat::since_iron;
  bool is_announced_ = false;
  std::map<ChannelId, ros2::RosWriter> writers_;
  std::optional<ReplayedRobots> robots_;
  std::vector<ChannelId> latched_;
  std::vector<std::pair<ChannelId, recording::Bytes>> clock_;  // messages of the time that is being played
  std::optional<Timestamp> first_;                             // log time at which this round began
  Timestamp last_{};
  WallClock::time_point begun_{};
  std::uint64_t played_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace

int play_to_ros2(const Ros2Playback& playback, Log& log, const std::atomic<bool>& stop) {
  const recording::McapReader reader(playback.file);
  if (!reader.is_complete()) log.warning(reader.damage());
  return Player(playback, reader, log, stop).run();
}

}  // namespace cohort::tool
