// SPDX-License-Identifier: Apache-2.0
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

/// The common parts of runs over DDS and in one process.
namespace cohort::session {

/// A request of a client to replace the run.
struct NextRun {
  std::uint64_t seed = 0;
  std::shared_ptr<const SessionSnapshot> snapshot{};  ///< the snapshot to continue from; null: from the beginning
  PlaybackState state = PlaybackState::playing;
  double speed = 0.0;
  std::string rewound{};  ///< why the server itself went back to the snapshot; empty: a client requested this run
};

struct RunOptions {
  double speed = 0.0;                            ///< maximum simulated seconds per wall second; 0: as fast as possible
  PlaybackState state = PlaybackState::playing;  ///< initial state
  /// The snapshot that the simulation was restored from, to restore the exchange too; null: the run starts at the
  /// beginning.
  std::shared_ptr<const SessionSnapshot> from{};
  /// Simulated time between snapshots in memory, which clients can go back to; 0: no snapshots.
  std::chrono::nanoseconds keep_interval{0};
  /// End the run with an error when its recording fails.
  bool needs_recording = false;
  std::string rewound{};  ///< see NextRun
  /// Builds the world of a reset or of a snapshot before this run ends. If it throws, the client gets the message as a
  /// reply, and the run continues. Empty: resets and loading of snapshots are not supported.
  std::function<void(const NextRun&)> prepare{};
};

/// A client's operation on a running world at a boundary, before the frames of the tick were sent: docs/protocol.md,
/// "Control".
struct ControlEvent {
  std::uint64_t tick = 0;
  std::string operation;          ///< its name, such as `SpawnEntity`
  std::string text;               ///< a human-readable sentence: what was done, and who requested it
  std::vector<std::byte> action;  ///< for an action on the world: the bytes for Simulation::act
};

/// The progress of a run.
struct Progress {
  std::chrono::nanoseconds time{0};      ///< simulated time
  std::chrono::nanoseconds duration{0};  ///< simulated time of the whole run
  double real_time_factor = 0.0;         ///< over the last report's interval
  bool started = false;                  ///< false while controllers are missing at the start
  bool unrecorded = false;               ///< its recording has ended early
  bool paused = false;                   ///< until a client continues the run
  std::vector<std::string> awaited;      ///< names of the robots that the run waits for, in order
  std::string awaited_from;              ///< the client that drives the first of them, if any
  std::chrono::nanoseconds waiting{0};   ///< wall time since the start of the wait
};

/// An answer that missed its deadline.
struct Miss {
  std::uint64_t tick = 0;        ///< tick at which it was needed
  std::uint64_t frame_tick = 0;  ///< tick of the frame that it would have answered
  std::uint32_t robot = 0;
  description::OnLate consequence = description::OnLate::hold;
  std::chrono::nanoseconds waited{0};  ///< wall time
};

struct RunResult;

/// Callbacks of a run, on its thread. Each may be empty.
struct RunListener {
  std::function<void(const Progress&)> progress{};  ///< a few times a second, also while waiting
  std::function<void(const RunEvent&)> event{};     ///< each event; its count is the number of new occurrences
  std::function<void(const RunEvent&)> news{};      ///< the first event of each kind and text
  std::function<void(const Miss&)> miss{};
  /// Called after each step and at the start of the run, before the frames of this tick are sent.
  std::function<void()> stepped{};
  /// Called when the state of a tick is complete and its frames are sent: once for each tick, from the run's first to
  /// its last. The last one has no frames if the run ends there.
  std::function<void()> boundary{};
  /// Only for a run in one process: called at each boundary, before its frames are sent. `take` takes a snapshot of the
  /// current run.
  std::function<void(const std::function<SessionSnapshot()>& take)> can_save{};
  /// Only for a run in one process: called once, before its controllers are called. `fail` ends the run in its current
  /// state and returns its result, for the case that a controller ends the process. `fail` is valid until the run
  /// returns.
  std::function<void(std::function<RunResult(const std::string& why)> fail)> can_fail{};
  /// Called when a tick has its answers, with the wall time since its first frame was sent.
  std::function<void(std::chrono::nanoseconds)> barrier{};
  /// Called when the simulation has the commands of a tick, before it steps, with the robots whose commands have
  /// changed.
  std::function<void(std::span<const std::uint32_t>)> commands{};
  std::function<void(const ControlEvent&)> control{};
  /// Called at each boundary, and while the run waits. Returns why a required recording has ended, if it has.
  std::function<std::optional<std::string>()> unrecorded{};
  /// Called after the last step, or when there will be none. `unrecorded` is called once more afterwards.
  std::function<void()> stopped{};
};

struct RunResult {
  enum class End {
    finished,     ///< the whole duration was simulated, or a stop condition of the experiment was met
    interrupted,  ///< stopped by a signal or `stop`
    failed,       ///< `error` says why
    shut_down,    ///< ended by a client
    reset,        ///< `next` replaces it, from the beginning
    restored,     ///< `next` replaces it, from a snapshot
  };
  End end = End::finished;
  std::string error;
  std::optional<NextRun> next{};  ///< for `reset` and `restored`
  std::string unrecorded{};       ///< why the recording ended before its run; empty if it did not
  std::string stop_reason;        ///< the stop condition that was met; empty if none was
  std::uint64_t ticks = 0;
  std::chrono::nanoseconds sim_time{0};
  std::chrono::nanoseconds wall_time{0};  ///< from the first frame to the last step
  std::uint64_t state_hash = 0;
  std::uint32_t robots = 0;
  std::vector<std::string> newcomers;   ///< names of the robots that joined during the run, by id
  lockstep::LatencyHistogram barrier;   ///< from the first sent frame of a tick to the last required answer
  std::uint64_t late = 0;               ///< answers that missed their deadline
  std::uint64_t resent = 0;             ///< frames that were resent
  std::uint64_t repeated = 0;           ///< answers to frames that had been answered, or that were no longer pending
  std::vector<Miss> misses;             ///< the first million missed answers, in order
  lockstep::LatencyHistogram lateness;  ///< start of each tick relative to the requested speed; empty without one
  std::uint64_t late_ticks = 0;         ///< ticks that started more than one step late at that speed
  TouchCounts touches;
  physics::Convergence convergence;
  std::vector<RunEvent> events;
};

}  // namespace cohort::session
