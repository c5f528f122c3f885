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

/// A client of a Cohort server that drives robots from a loop of its own: for bridges to firmware and hardware, for
/// programs that own their `main`, and for bindings to other languages. Controllers that are called back are in
/// <cohort/controller.hpp>.
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
/// The client runs the protocol (docs/protocol.md) on a thread of its own: it attaches, asks again for what was lost,
/// and answers repeated frames. The simulation waits for this client between an event and its answer, as long as the
/// team's `on_late` allows. Values are float64 in SI units, as in controllers.
namespace cohort {

enum class Severity { info, warning, error };

struct ClientOptions {
  std::string server = "127.0.0.1";        ///< IPv4 address or host name
  std::uint32_t domain = 0;                ///< the server's DDS domain
  std::vector<std::string> robots{"all"};  ///< selectors: `all`, `3`, `0..7`, `explorers/sbot_7`, `explorers/*`
  std::string name{};                      ///< shown by the server; the controller's if empty
  std::string secure{};                    ///< folder of an identity (docs/security.md); empty: without security
  /// Of `run_client` only: runs `step` on the thread of DDS that brings the frame, which saves a hand-over between
  /// threads. `step` then runs on either thread, on one at a time. DDS stands still meanwhile: after eight frames in a
  /// row that take more than a millisecond, all further ones are the calling thread's.
  bool inline_step = false;
  /// Whether a failure before the first answer ends the run, as a later one does. If not, the server refuses this
  /// client, and the run waits for another.
  bool start_must_succeed = false;
  /// Receives messages for people, one at a time, on any thread of the client. If empty they go to standard error,
  /// after the name.
  std::function<void(Severity severity, const std::string& text)> tell{};
};

/// Replaces what COHORT_SERVER, COHORT_DOMAIN and COHORT_SECURE set. Throws std::invalid_argument if the domain is
/// not a number.
void take_environment(ClientOptions& options);

/// Splits selectors that are separated by commas.
std::vector<std::string> split_selectors(std::string_view list);

enum class ClientEnd {
  finished,     ///< the server ended the run
  refused,      ///< the claim was refused
  superseded,   ///< another process took these robots over
  failed,       ///< this client failed, or the server rejected an answer for good
  server_lost,  ///< the server died or left
  interrupted,  ///< the client was asked to stop
};

/// When a robot's team is asked for commands, and when they act (docs/semantics.md). A robot is asked at each tick for
/// which `tick % period == phase`; its command acts `delay` ticks after that tick, and until the next one acts.
struct Policy {
  bool waits = true;         ///< the run waits for answers (`mode: lockstep`); else it keeps its pace (`mode: free`)
  std::uint32_t period = 1;  ///< [ticks]
  std::uint32_t phase = 0;   ///< [ticks]
  std::uint32_t delay = 0;   ///< [ticks]
};

/// A robot that this client drives: its names, channels, parameters and seed, and its team's policy.
struct DrivenRobot {
  Start start;
  Policy policy;
};

/// The client holds a lease on these robots from now on, and no other lease: at first, after a takeover, and each time
/// that the world was reset or restored, which `robots[i].start.reason` says. Channels have to be looked up again.
struct LeaseStart {
  std::uint64_t tick = 0;                 ///< of the first frame to come
  std::chrono::nanoseconds step{0};       ///< simulated time between ticks
  std::span<const DrivenRobot> robots{};  ///< ascending ids; valid until the next LeaseStart
};

/// A robot of a frame. Commands are neutral until they are set.
struct FrameRobot {
  const DrivenRobot* robot = nullptr;
  Observation observation;
  Command command;
};

/// The observations of one tick, of the robots that are due at it, to be answered with their commands.
struct Frame {
  std::uint64_t tick = 0;
  std::chrono::nanoseconds time{0};  ///< simulated, since tick 0
  std::span<FrameRobot> robots{};    ///< ascending ids
};

/// A snapshot of the run is taken between frames: write what the program remembers of this robot since its lease
/// started, at most `largest_state` bytes, or call `state->leave_out()`. One event for each robot.
struct SaveState {
  const DrivenRobot* robot = nullptr;
  StateWriter* state = nullptr;
};

/// The run goes on from a snapshot: read, to the last byte, what SaveState wrote. Comes right after LeaseStart, for
/// each robot whose state the snapshot has.
struct LoadState {
  const DrivenRobot* robot = nullptr;
  StateReader* state = nullptr;
};

/// Nothing will follow.
struct ClientEnded {
  ClientEnd end = ClientEnd::failed;
  std::string why{};  ///< for people; empty if the run finished
};

/// No pointer in an event is null. What is in an event, but for ClientEnded, is valid until the next call of `answer`,
/// `fail` or `next`, unless it says otherwise.
using ClientEvent = std::variant<LeaseStart, Frame, SaveState, LoadState, ClientEnded>;

/// An attachment to a server. All functions are for one thread at a time.
class Client {
 public:
  /// Begins to attach and returns at once; a server that is not there yet is waited for. An address or an identity that
  /// cannot be used comes as ClientEnded.
  explicit Client(const ClientOptions& options);
  /// Leaves the run, without an answer if one is due. The robots are then without a controller, as if the process had
  /// died.
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Answers the event under way, if it was not answered yet, waits for the next one and returns it. Returns
  /// ClientEnded each time once the client has ended.
  ClientEvent next();
  /// The same, but returns nothing if no event comes within `at_most`, which may be 0.
  std::optional<ClientEvent> next(std::chrono::milliseconds at_most);

  /// Hands the event under way back, so that the simulation goes on while the caller does something else. Does nothing
  /// if no event is under way.
  void answer();

  /// Ends the client because it cannot go on: of a LeaseStart, that it cannot drive these robots. The server is told
  /// `why`; `next` returns ClientEnded. Does nothing if no event is under way.
  void fail(const std::string& why);

  /// Returns whether nobody wants the answer to the event under way any more: the server has ended the run or the
  /// lease, or has been away for too long. Polled by programs that wait for hardware before they answer.
  bool is_over() const;

  /// A file descriptor that poll(2) and select(2) report as readable while `next` would return at once. Not to be read
  /// or closed.
  int descriptor() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Attaches to a server and calls controllers of `plugin` until the run ends, and returns why it ended. Tells what
/// anything but `finished` is about. Waits for a server that is not there yet. Blocks; controllers run on the calling
/// thread, unless `inline_step`. `stop` may be set from a signal handler. Throws std::runtime_error if the server's
/// address or the identity cannot be used.
ClientEnd run_client(const Plugin& plugin, const ClientOptions& options, const std::atomic<bool>& stop);

/// Sets what it returns on SIGINT, SIGTERM and SIGHUP (a closed terminal; not under nohup) from now on, so that a
/// program can end in order. A second one of them ends the process at once.
std::atomic<bool>& stop_on_signals();

/// Returns the exit code of a program whose client ended so: 0 finished, 2 refused, 130 interrupted, 1 anything else.
int exit_code_of(ClientEnd end);

}  // namespace cohort
