#pragma once

#include <chrono>
#include <cohort/types.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Looks on at the runs of a Cohort server: where its robots are at each tick, the state hash, and what happens. An
/// observer drives nothing, is never waited for and cannot slow the server. What it misses is gone, so ticks may be
/// missing: a program that must have all of them records the run, or drives a robot.
///
///     cohort::Observer observer({.domain = 7});
///     while (!observer.ended())
///       if (const auto state = observer.next(std::chrono::milliseconds(100)))
///         for (const cohort::ObservedPose& robot : state->robots) ... robot.pose.position.x ...
///
/// Poses are in the world frame, in SI units. To change the run there is <cohort/control.hpp>.
namespace cohort {

struct ObserverOptions {
  std::string server = "127.0.0.1";  ///< IPv4 address or host name
  std::uint32_t domain = 0;          ///< the server's DDS domain, the first if it has several
  std::string secure{};              ///< folder of an observer's identity (docs/security.md); empty: without security
  std::string label = "observer";    ///< what the server calls this program; process and host are added
};

/// Replaces what COHORT_SERVER, COHORT_DOMAIN and COHORT_SECURE set. Throws std::invalid_argument if the domain is
/// not a number.
void take_environment(ObserverOptions& options);

/// A robot's pose: that of its root link.
struct ObservedPose {
  std::uint32_t robot = 0;  ///< id in this run
  WorldPose pose;
};

/// The world at a boundary between two ticks.
struct WorldState {
  std::uint32_t run = 0;  ///< higher after each reset or restore, when ticks may begin again
  std::uint64_t tick = 0;
  std::chrono::nanoseconds time{0};  ///< simulated, since tick 0
  std::uint64_t state_hash = 0;      ///< of the world's whole state
  std::vector<ObservedPose> robots;  ///< of all robots in the world, by ascending id
};

struct ObservedRobot {
  std::uint32_t robot = 0;  ///< id in this run
  std::string name;         ///< scoped, such as `explorers/sbot_7`
  std::string model;        ///< such as `sbot`
  std::string team;         ///< in the experiment file; empty if it has none
};

enum class ObserverEnd {
  run_ended,    ///< the server has said that there will be no further run
  server_gone,  ///< the server died, or left without a word
};

struct ObserverEnded {
  ObserverEnd end = ObserverEnd::server_gone;
  std::string how;  ///< of a run that ended: `finished`, `interrupted`, `failed` and other words of recordings
  std::string why;  ///< for people; maybe empty
};

/// A connection that only listens. All methods are for one thread at a time; those with `at_most` block for no longer.
class Observer {
 public:
  /// How many world states wait for `next`. When more come, the oldest is dropped.
  static constexpr std::size_t most_waiting = 64;

  /// Returns at once; a server that is not there yet is waited for. Throws ControlError (<cohort/control.hpp>,
  /// `no_attachment`) if the address or the identity cannot be used.
  explicit Observer(const ObserverOptions& options);
  ~Observer();
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

  /// Waits for the oldest world state that was not returned yet. Returns nothing if none comes within `at_most`, which
  /// may be 0, or once the server has ended or gone. A tick comes again when a paused run goes on, and when its world
  /// was changed.
  std::optional<WorldState> next(std::chrono::milliseconds at_most);
  /// Returns the newest world state that has come, at once; nothing if none has. A paused run publishes none
  /// but when it is changed.
  std::optional<WorldState> latest() const;
  /// A file descriptor that poll(2) and select(2) report as readable while `next` would return at once. Not to be read
  /// or closed.
  int descriptor() const;
  /// Returns why nothing more comes, or nothing while there is a server or none has been there yet. States that came
  /// before are still returned by `next`. A server that is killed is missed after some 5 s. When another server takes
  /// its place, the observer goes on with that one.
  std::optional<ObserverEnded> ended() const;

  /// Returns names, models and teams of all robots of the run, by ascending id; nothing if the server has not told them
  /// within `at_most`. Asks the server for a description of the whole scene, so call it once for each run and when
  /// robots with new ids have come, not for each tick.
  std::optional<std::vector<ObservedRobot>> robots(std::chrono::milliseconds at_most);
  /// Returns what has happened in the run since the last call, at first all: a query to the server, for programs that
  /// ask once a second or so. After a reset or a restore, `run` is another number, and all events of the new run are
  /// returned. Returns nothing if the server does not answer within `at_most`. Throws ControlError if it refuses.
  std::optional<RunHistory> events(std::chrono::milliseconds at_most);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort
