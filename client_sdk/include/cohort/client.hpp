#pragma once

#include <atomic>
#include <chrono>
#include <cohort/controller.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// A client of a Cohort server that drives robots from its own loop. It is for bridges to firmware and hardware, for
/// programs that own their `main`, and for bindings to other languages. <cohort/controller.hpp> has controllers with
/// callbacks.
///
///     cohort::Client client({.domain = 7, .robots = {"0..3"}});
///     for (;;) {
///       const cohort::ClientEvent event = client.next();
///       if (const auto* start = std::get_if<cohort::LeaseStart>(&event)) ... start->robots[0].start.command("…") ...
///       if (const auto* frame = std::get_if<cohort::Frame>(&event)) {
///         for (cohort::FrameRobot& robot : frame->robots) robot.command.set(…);
///         client.answer();
///       }
///       if (std::get_if<cohort::ClientEnded>(&event)) break;
///     }
///
/// The client runs the protocol (docs/protocol.md) on its own thread: it attaches, requests lost messages again and
/// answers repeated frames. The simulation waits for this client between an event and its answer, as long as the team's
/// `on_late` allows. Values are float64 in SI units, as in controllers.
namespace cohort {

enum class Severity { info, warning, error };

struct ClientOptions {
  std::string server = "127.0.0.1";        ///< IPv4 address or host name
  std::uint32_t domain = 0;                ///< the server's DDS domain
  std::vector<std::string> robots{"all"};  ///< selectors: `all`, `3`, `0..7`, `explorers/sbot_7`, `explorers/*`
  std::string name{};                      ///< name shown by the server; the controller's name if empty
  std::string secure{};                    ///< folder of an identity (docs/security.md); no security if empty
  /// Runs `step` on the DDS thread that receives the frame, which saves a hand-over between threads. Used by
  /// `run_client` only. `step` then runs on either thread, one at a time. DDS is blocked during a step: after eight
  /// consecutive frames that take more than a millisecond, all further ones run on the calling thread.
  bool inline_step = false;
  /// Ends the run if the client fails before its first answer, as a later failure does. If false, the server refuses
  /// this client, and the run waits for another.
  bool start_must_succeed = false;
  /// Receives log messages, one at a time, on any thread of the client. If empty, they go to standard error, after the
  /// name.
  std::function<void(Severity severity, const std::string& text)> tell{};
};

/// Replaces the options that COHORT_SERVER, COHORT_DOMAIN and COHORT_SECURE set. Throws std::invalid_argument if the
/// domain is not a number.
void take_environment(ClientOptions& options);

/// Splits a comma-separated list of selectors.
std::vector<std::string> split_selectors(std::string_view list);

enum class ClientEnd {
  finished,     ///< the server ended the run
  refused,      ///< the claim was refused
  superseded,   ///< another process took over these robots
  failed,       ///< this client failed, or the server finally rejected an answer
  server_lost,  ///< the server died or left
  interrupted,  ///< the client was asked to stop
};

/// When a robot's team is asked for commands, and when the commands act (docs/semantics.md). A robot is asked at each
/// tick with `tick % period == phase`. Its command acts from `delay` ticks later until the next command acts.
struct Policy {
  bool waits = true;  ///< the run waits for answers (`mode: lockstep`); otherwise it keeps its pace (`mode: free`)
  std::uint32_t period = 1;  ///< [ticks]
  std::uint32_t phase = 0;   ///< [ticks]
  std::uint32_t delay = 0;   ///< [ticks]
};

/// A robot that this client drives: its names, channels, parameters, seed, and the policy of its team.
struct DrivenRobot {
  Start start;
  Policy policy;
};

/// The start of a lease: from now on the client drives these robots, and no others. It comes at first, after a
/// takeover, and each time that the world is reset or restored; `robots[i].start.reason` says which. Channels must be
/// looked up again.
struct LeaseStart {
  std::uint64_t tick = 0;                 ///< tick of the next frame
  std::chrono::nanoseconds step{0};       ///< simulated time between ticks
  std::span<const DrivenRobot> robots{};  ///< in ascending order of ids; valid until the next LeaseStart
};

/// A robot in a frame. Its command is neutral until it is set.
struct FrameRobot {
  const DrivenRobot* robot = nullptr;
  Observation observation;
  Command command;
};

/// The observations of one tick, of the robots that are due, to be answered with their commands.
struct Frame {
  std::uint64_t tick = 0;
  std::chrono::nanoseconds time{0};  ///< simulated time since tick 0
  std::span<FrameRobot> robots{};    ///< in ascending order of ids
};

/// A request for the state of a robot, for a snapshot of the run, taken between frames. Write the state that the
/// program has accumulated for this robot since the start of its lease, at most `largest_state` bytes, or call
/// `state->leave_out()`. There is one event for each robot.
struct SaveState {
  const DrivenRobot* robot = nullptr;
  StateWriter* state = nullptr;
};

/// The saved state of a robot, when the run continues from a snapshot. Read everything that SaveState wrote. The event
/// follows LeaseStart, for each robot whose state is in the snapshot.
struct LoadState {
  const DrivenRobot* robot = nullptr;
  StateReader* state = nullptr;
};

/// The last event.
struct ClientEnded {
  ClientEnd end = ClientEnd::failed;
  std::string why{};  ///< reason, for people; empty if the run finished
};

/// An event. Its pointers are not null. Its contents, except of ClientEnded, are valid until the next call of `answer`,
/// `fail` or `next`, unless stated otherwise.
using ClientEvent = std::variant<LeaseStart, Frame, SaveState, LoadState, ClientEnded>;

/// An attachment to a server. Call its functions from one thread at a time.
class Client {
 public:
  /// Starts to attach and returns at once; waits for a server that is not there yet. An unusable address or identity is
  /// reported as ClientEnded.
  explicit Client(const ClientOptions& options);
  /// Leaves the run without answering. The robots are then without a controller, as if the process had died.
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Answers the current event, if it has not been answered, waits for the next one and returns it. Returns ClientEnded
  /// on every call once the client has ended.
  ClientEvent next();
  /// Like `next()`, but returns nothing if no event comes within `at_most`, which may be 0.
  std::optional<ClientEvent> next(std::chrono::milliseconds at_most);

  /// Answers the current event, so that the simulation continues while the caller does something else. Does nothing if
  /// there is no current event.
  void answer();

  /// Releases the current frame without an answer, for hardware that is silent: the team's `deadline` applies and newer
  /// frames come. The previous commands continue to act. Throws std::logic_error if there is no current frame, or if
  /// the run waits for one of its robots.
  void leave_unanswered();

  /// Ends the client because it cannot continue; at a LeaseStart, because it cannot drive these robots. Sends `why` to
  /// the server; `next` then returns ClientEnded. Does nothing if there is no current event.
  void fail(const std::string& why);

  /// Returns true if the answer to the current event is no longer needed: the server has ended the run or the lease, or
  /// has been away for too long. Programs that wait for hardware before they answer poll this.
  bool is_over() const;

  /// Returns a file descriptor that poll(2) and select(2) report as readable while `next` would return at once. Do not
  /// read or close it.
  int descriptor() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Attaches to a server, calls the controllers of `plugin` until the run ends, and returns the reason. Logs every
/// reason other than `finished`. Waits for a server that is not there yet. Blocks; controllers run on the calling
/// thread, unless `inline_step` is set. A signal handler may set `stop`. Throws std::runtime_error if the server's
/// address or the identity cannot be used.
ClientEnd run_client(const Plugin& plugin, const ClientOptions& options, const std::atomic<bool>& stop);

/// Returns a flag that is set on SIGINT, SIGTERM and SIGHUP (a closed terminal; not under nohup), so that a program can
/// end in order. A second one of these signals ends the process at once.
std::atomic<bool>& stop_on_signals();

/// Returns the exit code of a program for the end of its client: 0 finished, 2 refused, 130 interrupted, 1 otherwise.
int exit_code_of(ClientEnd end);

}  // namespace cohort
