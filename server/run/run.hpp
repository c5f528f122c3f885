#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/description/experiment.hpp"
#include "server/lockstep/latency_histogram.hpp"
#include "server/run/playback.hpp"
#include "server/run/run_events.hpp"
#include "server/run/session_snapshot.hpp"
#include "server/simulation/simulation.hpp"

/// What a run over DDS and a run in one process have in common.
namespace cohort::session {

/// What whoever controls a run wants in its place.
struct NextRun {
  std::uint64_t seed = 0;
  std::shared_ptr<const SessionSnapshot> snapshot{};  ///< where it goes on from; none: from the beginning
  PlaybackState state = PlaybackState::playing;
  double speed = 0.0;
  std::string rewound{};  ///< why the server itself went back to the snapshot; empty: somebody asked for this run
};

struct RunOptions {
  double speed = 0.0;  ///< simulated seconds per wall second at the most; 0: as fast as it goes
  PlaybackState state = PlaybackState::playing;  ///< at first
  /// The simulation was restored from it, and the exchange has to be too; none: the run begins at the beginning.
  std::shared_ptr<const SessionSnapshot> from{};
  /// Simulated time between snapshots that stay in memory, so that whoever controls the run can go back; 0: none do.
  std::chrono::nanoseconds keep_interval{0};
  /// Whether it ends with an error when its recording does.
  bool needs_recording = false;
  std::string rewound{};  ///< as in NextRun
  /// Makes the world of a reset or of a snapshot, before this run is ended for it. What it throws is the answer to
  /// whoever asked, and the run goes on. Empty: there are neither resets nor snapshots to load.
  std::function<void(const NextRun&)> prepare{};
};

/// Something that somebody did to a running world at a boundary, before its frames went out: docs/protocol.md,
/// "Control".
struct ControlEvent {
  std::uint64_t tick = 0;
  std::string operation;          ///< its name, such as `SpawnEntity`
  std::string text;               ///< a sentence for people: who, and what
  std::vector<std::byte> action;  ///< of one that changes the world: what Simulation::act was given, for replay
};

/// How far a run is.
struct Progress {
  std::chrono::nanoseconds time{0};      ///< simulated
  std::chrono::nanoseconds duration{0};  ///< simulated, of the whole run
  double real_time_factor = 0.0;         ///< over the last report's interval
  bool started = false;                  ///< false while controllers are missing at the start
  bool unrecorded = false;               ///< it was to be recorded, and is no more
  bool paused = false;                   ///< until whoever controls the run lets it go on
  std::vector<std::string> awaited;      ///< names of the robots that are waited for, in order
  std::string awaited_from;              ///< who drives the first of them, if anybody does
  std::chrono::nanoseconds waiting{0};   ///< wall time since the wait began
};

/// An answer that missed its deadline.
struct Miss {
  std::uint64_t tick = 0;        ///< at which it was needed
  std::uint64_t frame_tick = 0;  ///< of the frame that it would have answered
  std::uint32_t robot = 0;
  description::OnLate consequence = description::OnLate::hold;
  std::chrono::nanoseconds waited{0};  ///< wall time
};

struct RunResult;

/// Told what happens, on the thread that runs. Each may be empty.
struct RunListener {
  std::function<void(const Progress&)> progress{};  ///< a few times a second, also while waiting
  std::function<void(const RunEvent&)> event{};     ///< each time; its count is that of this time
  std::function<void(const RunEvent&)> news{};      ///< the first event of its kind and text
  std::function<void(const Miss&)> miss{};
  /// A step is done, or the run begins: no frame of this tick is out.
  std::function<void()> stepped{};
  /// The state of a tick is complete and its frames are out: once for each tick, from the run's first to its last.
  std::function<void()> boundary{};
  /// Of a run in one process: at each boundary, before its frames go out. `take` makes a snapshot of the run as it is.
  std::function<void(const std::function<SessionSnapshot()>& take)> can_save{};
  /// Of a run in one process: once, before it calls its controllers. `fail` ends the run where it is, and makes its
  /// result: for a controller that ends the process. It is good until the run returns.
  std::function<void(std::function<RunResult(const std::string& why)> fail)> can_fail{};
  /// A tick has its answers: the wall time since its first frame was sent.
  std::function<void(std::chrono::nanoseconds)> barrier{};
  /// The commands of a tick are with the simulation, which is about to step: those of these robots have changed.
  std::function<void(std::span<const std::uint32_t>)> commands{};
  std::function<void(const ControlEvent&)> control{};
  /// Asked at each boundary, and while the run waits: why it is recorded no more, if it was to be.
  std::function<std::optional<std::string>()> unrecorded{};
  std::function<void()> stopped{};  ///< the last step is done, or there will be none
};

struct RunResult {
  enum class End {
    finished,     ///< the whole duration was simulated, or a stop condition of the experiment holds
    interrupted,  ///< asked to stop
    failed,       ///< `error` says why
    shut_down,    ///< whoever controls it wanted an end
    reset,        ///< `next` is to be run in its place, from the beginning
    restored,     ///< the same from a snapshot
  };
  End end = End::finished;
  std::string error;
  std::optional<NextRun> next{};  ///< of reset and restored
  std::string stop_reason;        ///< the stop condition that ended it; empty if none did
  std::uint64_t ticks = 0;
  std::chrono::nanoseconds sim_time{0};
  std::chrono::nanoseconds wall_time{0};  ///< from the first frame to the last step
  std::uint64_t state_hash = 0;
  std::uint32_t robots = 0;
  std::vector<std::string> newcomers;   ///< of these the names of those that came in mid-run, by their ids
  lockstep::LatencyHistogram barrier;   ///< from the first frame of a tick sent to the last answer needed
  std::uint64_t late = 0;               ///< answers that missed their deadline
  std::uint64_t resent = 0;             ///< frames that were sent again
  std::vector<Miss> misses;             ///< of these the first million, in order
  lockstep::LatencyHistogram lateness;  ///< at the asked speed, how late each tick began; empty if none is asked
  TouchCounts touches;
  std::vector<RunEvent> events;
};

}  // namespace cohort::session
