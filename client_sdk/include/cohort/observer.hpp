#pragma once

#include <chrono>
#include <cohort/types.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Observes the runs of a Cohort server: the poses of its robots at each tick, the state hash, and events. An observer
/// drives nothing, is never waited for and cannot slow down the server. It may miss ticks; a program that needs all of
/// them records the run, or drives a robot.
///
///     cohort::Observer observer({.domain = 7});
///     while (!observer.ended())
///       if (const auto state = observer.next(std::chrono::milliseconds(100)))
///         for (const cohort::ObservedPose& robot : state->robots) ... robot.pose.position.x ...
///
/// Poses are in the world frame, in SI units. <cohort/control.hpp> changes a run.
namespace cohort {

struct ObserverOptions {
  std::string server = "127.0.0.1";  ///< IPv4 address or host name
  std::uint32_t domain = 0;          ///< the server's DDS domain; the first one if it has several
  std::string secure{};              ///< folder of an observer's identity (docs/security.md); no security if empty
  std::string label = "observer";    ///< name of this program at the server; process and host are added
};

/// Replaces the options that COHORT_SERVER, COHORT_DOMAIN and COHORT_SECURE set. Throws std::invalid_argument if the
/// domain is not a number.
void take_environment(ObserverOptions& options);

/// The pose of a robot's root link.
struct ObservedPose {
  std::uint32_t robot = 0;  ///< id in this run
  WorldPose pose;
};

/// The world at a boundary between two ticks.
struct WorldState {
  std::uint32_t run = 0;  ///< increases after each reset or restore, when ticks may restart
  std::uint64_t tick = 0;
  std::chrono::nanoseconds time{0};  ///< simulated time since tick 0
  std::uint64_t state_hash = 0;      ///< hash of the whole world
  std::vector<ObservedPose> robots;  ///< all robots in the world, in ascending order of ids
};

struct ObservedRobot {
  std::uint32_t robot = 0;  ///< id in this run
  std::string name;         ///< scoped name, such as `explorers/sbot_7`
  std::string model;        ///< such as `sbot`
  std::string team;         ///< team in the experiment file; empty if there is none
};

enum class ObserverEnd {
  run_ended,    ///< the server has announced that no further run follows
  server_gone,  ///< the server died or left without notice
};

struct ObserverEnded {
  ObserverEnd end = ObserverEnd::server_gone;
  std::string how;  ///< end of the run: `finished`, `interrupted`, `failed` and other words of recordings
  std::string why;  ///< reason, for people; may be empty
};

/// A connection that only receives. Call its methods from one thread at a time; those with `at_most` block no longer
/// than that.
class Observer {
 public:
  /// Capacity of the queue of world states for `next`. When it is full, the oldest is dropped.
  static constexpr std::size_t most_waiting = 64;

  /// Returns at once; waits for a server that is not there yet. Throws ControlError (<cohort/control.hpp>,
  /// `no_attachment`) if the address or the identity cannot be used.
  explicit Observer(const ObserverOptions& options);
  ~Observer();
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

  /// Waits for the oldest world state that has not been returned. Returns nothing if none arrives within `at_most`,
  /// which may be 0, or after the end of the server. A tick is repeated when a paused run resumes, and when its world
  /// was changed.
  std::optional<WorldState> next(std::chrono::milliseconds at_most);
  /// Returns the newest world state at once; nothing if none has arrived. A paused run publishes a state only when it
  /// is changed.
  std::optional<WorldState> latest() const;
  /// Returns a file descriptor that poll(2) and select(2) report as readable while `next` would return at once. Do not
  /// read or close it.
  int descriptor() const;
  /// Returns why no further state arrives; nothing while there is a server or none has been there yet. `next` still
  /// returns the states that arrived before. A killed server is detected after about 5 s. If another server takes its
  /// place, the observer continues with that one.
  std::optional<ObserverEnded> ended() const;

  /// Returns names, models and teams of all robots of the run, in ascending order of ids; nothing if the server does
  /// not answer within `at_most`. Requests a description of the whole scene: call it once per run and when robots with
  /// new ids appear, not at each tick.
  std::optional<std::vector<ObservedRobot>> robots(std::chrono::milliseconds at_most);
  /// Returns the events of the run since the last call; the first call returns all. Queries the server: call it about
  /// once a second. After a reset or a restore, `run` is another number, and all events of the new run are returned.
  /// Returns nothing if the server does not answer within `at_most`. Throws ControlError if it refuses.
  std::optional<RunHistory> events(std::chrono::milliseconds at_most);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort
