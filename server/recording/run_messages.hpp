// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/core/channel.hpp"
#include "server/recording/ros_channels.hpp"

/// Cohort's own messages in a recording: the data for a replay, and the events of the run. In the file they have the
/// form of messages of a ROS 2 package `cohort_msgs`.
namespace cohort::recording {

using messages::field;

/// The reason why a world begins in a recording.
enum class Beginning : std::uint8_t {
  first = 0,     ///< a run begins
  reset = 1,     ///< the world was rebuilt
  restored = 2,  ///< it continues from a snapshot, which follows
  attached = 3,  ///< the recording starts during a run, with a snapshot, which follows
};

/// The start of a world. The messages that follow belong to this world. Its ticks increase without gaps, starting at
/// `tick`.
struct WorldBegins {
  std::uint32_t run = 0;    ///< number of the run in this recording, from 0
  std::uint8_t reason = 0;  ///< a value of Beginning
  std::uint64_t seed = 0;
  std::uint64_t tick = 0;          ///< tick of its first boundary
  std::int64_t duration_ns = 0;    ///< simulated time at which the run ends at the latest
  std::int64_t log_offset_ns = 0;  ///< log time minus simulated time
  static constexpr const char* topic = "/cohort/world";
  static constexpr const char* type = "cohort_msgs/msg/WorldBegins";
  static constexpr auto fields =
      std::tuple(field("run", &WorldBegins::run), field("reason", &WorldBegins::reason),
                 field("seed", &WorldBegins::seed), field("tick", &WorldBegins::tick),
                 field("duration_ns", &WorldBegins::duration_ns), field("log_offset_ns", &WorldBegins::log_offset_ns));
};

/// The definition of a channel of a robot's observation or command.
struct RecordedChannel {
  std::string name;  ///< `device/index/quantity`
  std::string unit;
  std::uint32_t size = 1;
  static constexpr const char* type = "cohort_msgs/msg/Channel";
  static constexpr auto fields =
      std::tuple(field("name", &RecordedChannel::name), field("unit", &RecordedChannel::unit),
                 field("size", &RecordedChannel::size));
};
struct RecordedKind {
  std::string model;
  std::vector<RecordedChannel> observation;
  std::vector<RecordedChannel> command;
  static constexpr const char* type = "cohort_msgs/msg/RobotKind";
  static constexpr auto fields =
      std::tuple(field("model", &RecordedKind::model), field("observation", &RecordedKind::observation),
                 field("command", &RecordedKind::command));
};
struct RecordedRobot {
  std::string name;
  std::string team;
  std::uint32_t kind = 0;       ///< index into Roster::kinds
  std::vector<double> command;  ///< at the start of the world
  static constexpr const char* type = "cohort_msgs/msg/Robot";
  static constexpr auto fields =
      std::tuple(field("name", &RecordedRobot::name), field("team", &RecordedRobot::team),
                 field("kind", &RecordedRobot::kind), field("command", &RecordedRobot::command));
};
/// The robots by id; written at the start of each world.
struct Roster {
  std::vector<RecordedKind> kinds;
  std::vector<RecordedRobot> robots;
  static constexpr const char* topic = "/cohort/roster";
  static constexpr const char* type = "cohort_msgs/msg/Roster";
  static constexpr auto fields = std::tuple(field("kinds", &Roster::kinds), field("robots", &Roster::robots));
};

/// The state at a boundary, after the actions taken at it and before its commands.
struct Boundary {
  std::uint64_t tick = 0;
  std::uint64_t state_hash = 0;
  static constexpr const char* topic = "/cohort/boundary";
  static constexpr const char* type = "cohort_msgs/msg/Boundary";
  static constexpr auto fields = std::tuple(field("tick", &Boundary::tick), field("state_hash", &Boundary::state_hash));
};

/// The commanded values that change at a boundary: `values[i]` is the new one at place `places[i]` in the command of
/// robot `robots[i]`.
struct Commands {
  std::uint64_t tick = 0;
  std::vector<std::uint32_t> robots;  ///< ids, ascending
  std::vector<std::uint32_t> places;  ///< indices of the channels of the robot's kind, ascending for each robot
  std::vector<double> values;
  static constexpr const char* topic = "/cohort/commands";
  static constexpr const char* type = "cohort_msgs/msg/Commands";
  static constexpr auto fields = std::tuple(field("tick", &Commands::tick), field("robots", &Commands::robots),
                                            field("places", &Commands::places), field("values", &Commands::values));
};

/// Decodes a Commands message. Throws messages::CdrError if the bytes are invalid, or if the three lists differ in
/// length.
Commands decode_commands(ByteView bytes);

/// An action on the world from outside, at a boundary.
struct ActionTaken {
  std::uint64_t tick = 0;
  std::string text;                  ///< human-readable description
  std::vector<std::uint8_t> action;  ///< encoded by cohort::to_bytes
  static constexpr const char* topic = "/cohort/action";
  static constexpr const char* type = "cohort_msgs/msg/ActionTaken";
  static constexpr auto fields = std::tuple(field("tick", &ActionTaken::tick), field("text", &ActionTaken::text),
                                            field("action", &ActionTaken::action));
};

struct RecordedEvent {
  std::uint64_t tick = 0;
  std::string kind;  ///< a keyword
  std::string text;
  std::uint64_t count = 1;
  static constexpr const char* topic = "/cohort/event";
  static constexpr const char* type = "cohort_msgs/msg/Event";
  static constexpr auto fields = std::tuple(field("tick", &RecordedEvent::tick), field("kind", &RecordedEvent::kind),
                                            field("text", &RecordedEvent::text), field("count", &RecordedEvent::count));
};

/// An answer that missed its deadline.
struct RecordedMiss {
  std::uint64_t tick = 0;
  std::uint64_t frame_tick = 0;  ///< tick of the frame that it would have answered
  std::uint32_t robot = 0;
  std::string on_late;  ///< the policy that was applied, as in an experiment file
  double waited = 0.0;  ///< wall time [s]
  static constexpr const char* topic = "/cohort/miss";
  static constexpr const char* type = "cohort_msgs/msg/Miss";
  static constexpr auto fields =
      std::tuple(field("tick", &RecordedMiss::tick), field("frame_tick", &RecordedMiss::frame_tick),
                 field("robot", &RecordedMiss::robot), field("on_late", &RecordedMiss::on_late),
                 field("waited", &RecordedMiss::waited));
};

/// The whole state at a boundary, as saved by Simulation::save.
struct RecordedSnapshot {
  std::uint64_t tick = 0;
  std::vector<std::uint8_t> data;
  static constexpr const char* topic = "/cohort/snapshot";
  static constexpr const char* type = "cohort_msgs/msg/Snapshot";
  static constexpr auto fields =
      std::tuple(field("tick", &RecordedSnapshot::tick), field("data", &RecordedSnapshot::data));
};

/// The observations of a robot are on the topic `/NAME/observation`. Their type depends on the robot's kind: the
/// simulated time as `builtin_interfaces/Time stamp`, then a float64 or an array of them for each channel.
inline constexpr const char* observation_topic_end = "/observation";
/// Returns a channel's name in a form that ROS allows: `proximity_3_reading`.
std::string ros_field_name(std::string_view channel);
/// Returns the message type of the robots of a model: `SbotDetailedObservation`.
std::string observation_type(std::string_view model);
/// Returns the schema of this message, with a field for each channel of an observation.
std::string observation_schema(std::span<const cohort::Channel> channels);

}  // namespace cohort::recording
