// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cohort/types.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// A client that observes the runs of a Cohort server: the poses of the robots at each tick, the state hash, and
/// events. An observer drives no robots. The server never waits for it, so it cannot slow down the run, but it may miss
/// ticks. A program that needs every tick must record the run or drive a robot.
///
///     cohort::Observer observer({.domain = 7});
///     while (!observer.ended())
///       if (const auto state = observer.next(std::chrono::milliseconds(100)))
///         for (const cohort::ObservedPose& robot : state->robots) ... robot.pose.position.x ...
///
/// Poses are in the world frame, in SI units. To change a run, use <cohort/control.hpp>.
namespace cohort {

struct ObserverOptions {
  std::string server = "127.0.0.1";  ///< IPv4 address or host name
  std::uint32_t domain = 0;          ///< the server's DDS domain; the first domain if it has several
  std::string secure{};              ///< folder of an observer's identity (docs/security.md); no security if empty
  std::string label = "observer";    ///< name that the server shows for this program, with process id and host
};

/// Sets `server`, `domain` and `secure` from COHORT_SERVER, COHORT_DOMAIN and COHORT_SECURE, if those are set. Throws
/// std::invalid_argument if the domain is not a number.
void take_environment(ObserverOptions& options);

/// The pose of a robot's root link.
struct ObservedPose {
  std::uint32_t robot = 0;  ///< id in this run
  WorldPose pose;
};

/// The world at a boundary between two ticks.
struct WorldState {
  std::uint32_t run = 0;  ///< number of the run; increases after each reset or restore, when the tick may decrease
  std::uint64_t tick = 0;
  std::chrono::nanoseconds time{0};  ///< simulated time since tick 0
  std::uint64_t state_hash = 0;      ///< hash of the whole world
  std::vector<ObservedPose> robots;  ///< all robots that are in the world, in ascending order of ids
};

struct ObservedRobot {
  std::uint32_t robot = 0;  ///< id in this run
  std::string name;         ///< scoped name, such as `explorers/sbot_7`
  std::string model;        ///< such as `sbot`
  std::string team;         ///< team in the experiment file; empty if there is none
};

enum class ObserverEnd {
  run_ended,    ///< the server has announced that no further run follows
  server_gone,  ///< the server crashed or exited without notice
};

struct ObserverEnded {
  ObserverEnd end = ObserverEnd::server_gone;
  std::string how;  ///< how the run ended: a keyword such as `finished`, `interrupted` or `failed`, as in recordings
  std::string why;  ///< human-readable reason; may be empty
};

/// A connection that only receives data. Call its methods from one thread at a time. Methods with the parameter
/// `at_most` block no longer than that.
class Observer {
 public:
  /// Capacity of the queue of world states for `next`. When the queue is full, the oldest state is dropped.
  static constexpr std::size_t most_waiting = 64;

  /// Connects to the server. Does not block. If there is no server yet, connects when one appears. Throws ControlError
  /// (<cohort/control.hpp>, `no_attachment`) if the address or the identity cannot be used.
  explicit Observer(const ObserverOptions& options);
  ~Observer();
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

  /// Waits for the oldest world state that has not been returned yet, and returns it. Returns nothing if none arrives
  /// within `at_most`, which may be 0, or if the server has ended. A tick is repeated when a paused run resumes or its
  /// world is changed.
  std::optional<WorldState> next(std::chrono::milliseconds at_most);
  /// Returns the newest world state, or nothing if none has arrived. Does not block. A paused run publishes a state
  /// only when its world is changed.
  std::optional<WorldState> latest() const;
  /// Returns a file descriptor that poll(2) and select(2) report as readable while `next` would not block. Do not read
  /// or close it.
  int descriptor() const;
  /// Returns the reason why no further states arrive, or nothing while there is a server or before the first one
  /// appears. `next` still returns the states that arrived earlier. A killed server is detected after about 5 s. If
  /// another server takes its place, the observer continues with the new server.
  std::optional<ObserverEnded> ended() const;

  /// Returns the names, models and teams of all robots of the run, in ascending order of ids. Returns nothing if the
  /// server does not answer within `at_most`. Requests a description of the whole scene: call it once per run and when
  /// robots with new ids appear, not at each tick.
  std::optional<std::vector<ObservedRobot>> robots(std::chrono::milliseconds at_most);
  /// Returns the events of the run since the last call; the first call returns all events. Queries the server: call it
  /// at most about once a second. After a reset or a restore, `RunHistory::run` has changed, and all events of the new
  /// run are returned. Returns nothing if the server does not answer within `at_most`. Throws ControlError if the
  /// server rejects the request.
  std::optional<RunHistory> events(std::chrono::milliseconds at_most);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort
