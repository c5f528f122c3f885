#pragma once

#include "server/recording/ros_channels.hpp"

/// The messages of a recording that are Cohort's own: what replays a run, and what happened in it. In the file they are
/// as messages of a ROS 2 package `cohort_msgs` would be.
namespace cohort::recording {

using messages::field;

/// Why a world begins in a recording.
enum class Beginning : std::uint8_t {
  first = 0,     ///< a run begins
  reset = 1,     ///< the world was built anew
  restored = 2,  ///< it goes on from a snapshot, which follows
  attached = 3,  ///< the recording of a run begins in its midst, with a snapshot, which follows
};

/// A world begins; what follows is of it. Ticks of one world go up, from `tick` on, without a gap.
struct WorldBegins {
  std::uint32_t run = 0;    ///< number of the run in this recording, from 0
  std::uint8_t reason = 0;  ///< a Beginning
  std::uint64_t seed = 0;
  std::uint64_t tick = 0;          ///< of its first boundary
  std::int64_t duration_ns = 0;    ///< simulated time at which the run ends at the latest
  std::int64_t log_offset_ns = 0;  ///< log time less simulated time
  static constexpr const char* topic = "/cohort/world";
  static constexpr const char* type = "cohort_msgs/msg/WorldBegins";
  static constexpr auto fields =
      std::tuple(field("run", &WorldBegins::run), field("reason", &WorldBegins::reason),
                 field("seed", &WorldBegins::seed), field("tick", &WorldBegins::tick),
                 field("duration_ns", &WorldBegins::duration_ns), field("log_offset_ns", &WorldBegins::log_offset_ns));
};

/// What the values of a robot are.
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
  std::vector<double> command;  ///< as the world begins
  static constexpr const char* type = "cohort_msgs/msg/Robot";
  static constexpr auto fields =
      std::tuple(field("name", &RecordedRobot::name), field("team", &RecordedRobot::team),
                 field("kind", &RecordedRobot::kind), field("command", &RecordedRobot::command));
};
/// The robots by id; with each world that begins.
struct Roster {
  std::vector<RecordedKind> kinds;
  std::vector<RecordedRobot> robots;
  static constexpr const char* topic = "/cohort/roster";
  static constexpr const char* type = "cohort_msgs/msg/Roster";
  static constexpr auto fields = std::tuple(field("kinds", &Roster::kinds), field("robots", &Roster::robots));
};

/// The state at a boundary, after the actions that were taken there and before its commands.
struct Boundary {
  std::uint64_t tick = 0;
  std::uint64_t state_hash = 0;
  static constexpr const char* topic = "/cohort/boundary";
  static constexpr const char* type = "cohort_msgs/msg/Boundary";
  static constexpr auto fields = std::tuple(field("tick", &Boundary::tick), field("state_hash", &Boundary::state_hash));
};

/// Commanded values that are others than before, from a boundary on: `values[i]` is the new one at place `places[i]`
/// in the command of robot `robots[i]`.
struct Commands {
  std::uint64_t tick = 0;
  std::vector<std::uint32_t> robots;  ///< ids, ascending
  std::vector<std::uint32_t> places;  ///< by the channels of the robot's kind, ascending for each robot
  std::vector<double> values;
  static constexpr const char* topic = "/cohort/commands";
  static constexpr const char* type = "cohort_msgs/msg/Commands";
  static constexpr auto fields = std::tuple(field("tick", &Commands::tick), field("robots", &Commands::robots),
                                            field("places", &Commands::places), field("values", &Commands::values));
};

/// Throws messages::CdrError if the three lists are not of one length.
Commands decode_commands(ByteView bytes);

/// What somebody outside did to the world at a boundary.
struct ActionTaken {
  std::uint64_t tick = 0;
  std::string text;                  ///< for people
  std::vector<std::uint8_t> action;  ///< as of cohort::to_bytes
  static constexpr const char* topic = "/cohort/action";
  static constexpr const char* type = "cohort_msgs/msg/ActionTaken";
  static constexpr auto fields = std::tuple(field("tick", &ActionTaken::tick), field("text", &ActionTaken::text),
                                            field("action", &ActionTaken::action));
};

struct RecordedEvent {
  std::uint64_t tick = 0;
  std::string kind;  ///< a word
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
  std::uint64_t frame_tick = 0;  ///< of the frame that it would have answered
  std::uint32_t robot = 0;
  std::string on_late;  ///< what was done without it, as an experiment writes it
  double waited = 0.0;  ///< wall time [s]
  static constexpr const char* topic = "/cohort/miss";
  static constexpr const char* type = "cohort_msgs/msg/Miss";
  static constexpr auto fields =
      std::tuple(field("tick", &RecordedMiss::tick), field("frame_tick", &RecordedMiss::frame_tick),
                 field("robot", &RecordedMiss::robot), field("on_late", &RecordedMiss::on_late),
                 field("waited", &RecordedMiss::waited));
};

/// The whole state at a boundary, as of Simulation::save.
struct RecordedSnapshot {
  std::uint64_t tick = 0;
  std::vector<std::uint8_t> data;
  static constexpr const char* topic = "/cohort/snapshot";
  static constexpr const char* type = "cohort_msgs/msg/Snapshot";
  static constexpr auto fields =
      std::tuple(field("tick", &RecordedSnapshot::tick), field("data", &RecordedSnapshot::data));
};

/// What a robot observes is on the topic `/NAME/observation`. The type of its messages is of the robot's kind: the
/// simulated time as `builtin_interfaces/Time stamp`, then a float64 or an array of them for each channel.
inline constexpr const char* observation_topic_end = "/observation";
/// A channel's name as ROS allows it: `proximity_3_reading`.
std::string ros_field_name(std::string_view channel);
/// The name of messages of a model's robots: `SbotDetailedObservation`.
std::string observation_type(std::string_view model);

}  // namespace cohort::recording
