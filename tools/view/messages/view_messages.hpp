// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/scene_messages.hpp"

/// Messages to viewers in addition to the scene (server/viewing/scene_messages.hpp).
namespace cohort::view {

using messages::field;

/// The state of playback. Times are log times for a recording, and simulated times for a server.
struct ViewStatus {
  std::string source;  ///< `recording`, `server`, or `program`, which steps its own world
  std::string name;    ///< name of the recording's file or of the experiment
  bool may_control = false;
  bool can_seek = false;            ///< to times from `seekable_from_ns` to `seekable_to_ns`
  bool loses_what_follows = false;  ///< seeking back discards later history
  bool is_playing = false;
  double speed = 1.0;             ///< requested simulated seconds per second; 0: as fast as possible
  double real_time_factor = 0.0;  ///< measured simulated seconds per second
  std::int64_t time_ns = 0;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;  ///< latest possible end
  std::int64_t seekable_from_ns = 0;
  std::int64_t seekable_to_ns = 0;
  std::string note{};                  ///< the reason why the run does not advance; empty if it does
  std::vector<std::string> awaited{};  ///< names of robots that the run waits for
  /// `waiting` for a server, `gathering` controllers before the first tick, `running`, `ended`, or `gone` if the server
  /// has disappeared without a message.
  std::string phase = "running";
  std::string end{};           ///< one of `finished`, `interrupted`, `failed`, `shut_down`
  std::string end_text{};      ///< reason of the end, for the user
  std::string to_type{};       ///< shell command that attaches a controller or repeats the run
  std::string recording{};     ///< name of the file that the request `replay` shows
  std::string seed{};          ///< seed of the run, in decimal; empty if unknown
  bool can_run_again = false;  ///< the request `again` repeats the run
  static constexpr const char* type = "cohort_msgs/msg/ViewStatus";
  static constexpr auto fields = std::tuple(
      field("source", &ViewStatus::source), field("name", &ViewStatus::name),
      field("may_control", &ViewStatus::may_control), field("can_seek", &ViewStatus::can_seek),
      field("loses_what_follows", &ViewStatus::loses_what_follows), field("is_playing", &ViewStatus::is_playing),
      field("speed", &ViewStatus::speed), field("real_time_factor", &ViewStatus::real_time_factor),
      field("time_ns", &ViewStatus::time_ns), field("begin_ns", &ViewStatus::begin_ns),
      field("end_ns", &ViewStatus::end_ns), field("seekable_from_ns", &ViewStatus::seekable_from_ns),
      field("seekable_to_ns", &ViewStatus::seekable_to_ns), field("note", &ViewStatus::note),
      field("awaited", &ViewStatus::awaited), field("phase", &ViewStatus::phase), field("end", &ViewStatus::end),
      field("end_text", &ViewStatus::end_text), field("to_type", &ViewStatus::to_type),
      field("recording", &ViewStatus::recording), field("seed", &ViewStatus::seed),
      field("can_run_again", &ViewStatus::can_run_again));
};

/// An event of a run, which may have occurred several times.
struct ViewEvent {
  std::int64_t time_ns = 0;  ///< first occurrence
  std::uint64_t tick = 0;
  std::string kind;  ///< a word
  std::string text;
  std::uint64_t count = 1;
  std::int64_t last_ns = 0;  ///< last occurrence
  static constexpr const char* type = "cohort_msgs/msg/ViewEvent";
  static constexpr auto fields = std::tuple(field("time_ns", &ViewEvent::time_ns), field("tick", &ViewEvent::tick),
                                            field("kind", &ViewEvent::kind), field("text", &ViewEvent::text),
                                            field("count", &ViewEvent::count), field("last_ns", &ViewEvent::last_ns));
};

/// The latest events of a run, oldest first, or all shown events of a recording.
struct ViewEvents {
  static constexpr std::size_t most = 1000;

  std::vector<ViewEvent> events;
  static constexpr const char* type = "cohort_msgs/msg/ViewEvents";
  static constexpr auto fields = std::tuple(field("events", &ViewEvents::events));
};

}  // namespace cohort::view
