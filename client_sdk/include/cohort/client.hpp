// SPDX-License-Identifier: Apache-2.0
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

/// A client of a Cohort server that drives robots from its own loop: for bridges to firmware and hardware, programs
/// with their own `main`, and bindings to other languages. For controllers with callbacks, see <cohort/controller.hpp>.
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
/// answers repeated frames. Between an event and its answer, the simulation waits for this client, as long as the
/// team's `on_late` allows. Values are float64 in SI units, as in controllers.
namespace cohort {

enum class Severity { info, warning, error };

struct ClientOptions {
  std::string server = "127.0.0.1";        ///< IPv4 address or host name
  std::uint32_t domain = 0;                ///< the server's DDS domain
  std::vector<std::string> robots{"all"};  ///< selectors: `all`, `3`, `0..7`, `explorers/sbot_7`, `explorers/*`
  std::string name{};                      ///< name shown by the server; the controller's name if empty
  std::string secure{};                    ///< folder of the client's identity (docs/security.md); no security if empty
  /// Runs `Controller::step` on the DDS thread that receives the frame, which saves a hand-over between threads. Used
  /// by `run_client` only. DDS is blocked during a step: if eight consecutive frames take more than a millisecond each,
  /// all further steps run on the thread that called `run_client`. Only one of the two threads runs steps at a time.
  bool inline_step = false;
  /// Makes a failure before the first answer end the run, like a later failure. If false, the server then refuses this
  /// client, and the run waits for another one.
  bool start_must_succeed = false;
  /// Receives log messages, one at a time, on any thread of the client. If empty, messages are written to standard
  /// error, each after the client's name.
  std::function<void(Severity severity, const std::string& text)> tell{};
};

/// Sets `server`, `domain` and `secure` from COHORT_SERVER, COHORT_DOMAIN and COHORT_SECURE, if those are set. Throws
/// std::invalid_argument if the domain is not a number.
void take_environment(ClientOptions& options);

/// Splits a comma-separated list of selectors.
std::vector<std::string> split_selectors(std::string_view list);

enum class ClientEnd {
  finished,     ///< the server has ended the run
  refused,      ///< the claim was refused
  superseded,   ///< another process has taken over these robots
  failed,       ///< this client failed, or the server ended the run with an error
  server_lost,  ///< the server crashed or exited
  interrupted,  ///< the client was asked to stop
};

/// The schedule of a team's commands (docs/semantics.md). A robot is due at each tick with `tick % period == phase`.
/// Its command takes effect `delay` ticks later and lasts until the next command takes effect.
struct Policy {
  bool waits = true;  ///< true: the run waits for answers (`mode: lockstep`); false: it never waits (`mode: free`)
  std::uint32_t period = 1;  ///< [ticks]
  std::uint32_t phase = 0;   ///< [ticks]
  std::uint32_t delay = 0;   ///< [ticks]
};

/// A robot that this client drives: its names, channels, parameters and seed, and the policy of its team.
struct DrivenRobot {
  Start start;
  Policy policy;
};

/// The start of a lease, the right to drive robots: from now on, the client drives these robots and no others. It is
/// the first event, and it occurs again after each takeover, reset and restore, and when `Client::claim` has added
/// robots; `robots[i].start.reason` gives the reason. Channels must be looked up again. A program that reads
/// `robots[i].start.parameters` must read all of them before it answers; otherwise the client ends with an error. A
/// program that reads none of them, such as a bridge, may drive robots whose parameters are for another controller.
struct LeaseStart {
  std::uint64_t tick = 0;                 ///< tick of the next frame
  std::chrono::nanoseconds step{0};       ///< simulated time between ticks
  std::span<const DrivenRobot> robots{};  ///< in ascending order of ids; valid until the next LeaseStart
};

/// A robot in a frame. Each value of its command is neutral until it is set.
struct FrameRobot {
  const DrivenRobot* robot = nullptr;
  Observation observation;
  Command command;
};

/// The observations of the robots that are due at one tick. The answer is their commands.
struct Frame {
  std::uint64_t tick = 0;
  std::chrono::nanoseconds time{0};  ///< simulated time since tick 0
  std::span<FrameRobot> robots{};    ///< in ascending order of ids
};

/// A request to save the controller state of a robot in a snapshot of the run, between two frames. Write the state that
/// the program has accumulated for this robot since the start of the lease, at most `largest_state` bytes, or call
/// `state->leave_out()`. Each robot has its own event.
struct SaveState {
  const DrivenRobot* robot = nullptr;
  StateWriter* state = nullptr;
};

/// The saved controller state of a robot, when the run continues from a snapshot. Read everything that was written at
/// SaveState. The event follows LeaseStart, once for each robot whose state is in the snapshot.
struct LoadState {
  const DrivenRobot* robot = nullptr;
  StateReader* state = nullptr;
};

/// The last event.
struct ClientEnded {
  ClientEnd end = ClientEnd::failed;
  std::string why{};  ///< human-readable reason; empty if the run finished
};

/// An event. Its pointers are not null. Unless stated otherwise, its contents are valid until the next call of
/// `answer`, `fail` or `next`; ClientEnded stays valid.
using ClientEvent = std::variant<LeaseStart, Frame, SaveState, LoadState, ClientEnded>;

/// An attachment to a server. Call its functions from one thread at a time.
class Client {
 public:
  /// Starts to attach to the server; does not block. If there is no server yet, attaches when one appears. Reports an
  /// unusable address or identity as ClientEnded.
  explicit Client(const ClientOptions& options);
  /// Detaches without answering the current event. The robots are then without a controller, as if the process had
  /// crashed.
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Answers the current event if it has not been answered, then waits for the next event and returns it. Returns
  /// ClientEnded on every call once the client has ended.
  ClientEvent next();
  /// Acts like `next()`, but returns nothing if no event arrives within `at_most`, which may be 0.
  std::optional<ClientEvent> next(std::chrono::milliseconds at_most);

  /// Replaces the selectors in `ClientOptions::robots`, for robots that are added during the run. New selectors add the
  /// robots that no client has driven yet, also later, as soon as they match; a LeaseStart follows. The client keeps
  /// the robots that it has. May be called from any thread.
  void claim(std::vector<std::string> robots);

  /// Answers the current event, so that the simulation continues while the caller does something else. Does nothing if
  /// there is no current event.
  void answer();

  /// Releases the current frame without an answer, for hardware that does not respond. The previous commands stay in
  /// effect, the team's `deadline` applies, and newer frames arrive. Throws std::logic_error if there is no current
  /// frame, or if the run waits for one of its robots.
  void leave_unanswered();

  /// Ends the client with the error `why`. Call this if the client cannot continue or, at a LeaseStart, cannot drive
  /// these robots. Sends `why` to the server; `next` then returns ClientEnded. Does nothing if there is no current
  /// event.
  void fail(const std::string& why);

  /// Returns true if the answer to the current event is no longer needed: the server has ended the run or the lease, or
  /// has been unreachable for too long. Poll this while your program waits for hardware before it answers.
  bool is_over() const;

  /// Returns a file descriptor that poll(2) and select(2) report as readable while `next` would not block. Do not read
  /// or close it.
  int descriptor() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Attaches to a server, calls the controllers of `plugin` until the run ends, and returns the reason for the end. Logs
/// every reason other than `finished`. Waits until there is a server. Blocks; controllers run on the calling thread
/// unless `inline_step` is set. Setting `stop` interrupts the client; this is allowed in a signal handler. Throws
/// std::runtime_error if the server's address or the identity cannot be used.
ClientEnd run_client(const Plugin& plugin, const ClientOptions& options, const std::atomic<bool>& stop);

/// Installs signal handlers and returns a flag that they set on SIGINT, SIGTERM and SIGHUP (a closed terminal; not
/// under nohup), so that a program can shut down cleanly. A second signal ends the process immediately.
std::atomic<bool>& stop_on_signals();

/// Returns the exit code for a program whose client has ended: 0 finished, 2 refused, 130 interrupted, 1 otherwise.
int exit_code_of(ClientEnd end);

}  // namespace cohort
