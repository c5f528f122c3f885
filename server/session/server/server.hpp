#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "idl/control_messages.hpp"
#include "idl/survey.hpp"
#include "idl/wire.hpp"
#include "server/lockstep/answer_times.hpp"
#include "server/lockstep/leases.hpp"
#include "server/lockstep/resend_timer.hpp"
#include "server/session/control/control.hpp"
#include "server/session/control/live_recordings.hpp"
#include "server/session/exchange.hpp"
#include "server/session/run_monitor.hpp"
#include "server/session/server/scene_broadcast.hpp"

namespace cohort::session {

/// Runs experiments whose controllers are DDS clients: docs/protocol.md, the server's side. Clients stay attached from
/// one run to the next. Callbacks of DDS put control messages aside and take answers at once under one lock; everything
/// else happens on the thread of `run`, which alone creates and destroys entities and steps the world.
class Server {
 public:
  /// `participants`: one for each DDS domain that is served, and with security one for each identity in each of them,
  /// at least one; a client may be in any of them, observers are in the first. They must outlive this.
  explicit Server(std::span<wire::Participant> participants);
  ~Server();

  /// Waits for a controller for every robot that requires one, and runs. Clients that were attached before are admitted
  /// to the new run, as far as their selectors select robots of it. Returns soon after `stop` is set, also while it
  /// waits, or when whoever controls the run wants an end or another run. Experiment and simulation must outlive this
  /// call only.
  RunResult run(const description::Experiment& experiment, Simulation& simulation, const RunOptions& options,
                const RunListener& listener, const std::atomic<bool>& stop);

  /// Tells all who drive robots that there will be no further run, how the last one ended, and waits a little until
  /// they have left.
  void dismiss(const RunResult& last);

  /// From any thread: ends the run with this error, unless a controller has reported one before.
  void fail(const std::string& error);
  /// From any thread: a process of this machine has ended, so the client in it is dead, whatever liveliness says.
  void note_process_end(std::uint32_t process);

 private:
  using Clock = RunMonitor::Clock;

  // A DDS domain that is served, or one identity's way into it. Readers last, so that no callback comes before all else
  // is there.
  struct Door {
    Door(Server& server, wire::Participant& participant);
    wire::Participant& participant;
    wire::Writer<wire::RobotDescription> descriptions;
    wire::Reader<wire::Join> joins;
    wire::Reader<wire::Command> commands;
    wire::Reader<wire::Report> reports;
    wire::Reader<wire::Request> requests;
    wire::VersionWatch versions;
  };

  struct Client {
    wire::Join join;
    std::uint64_t arrival = 0;                      // clients of a session in their order
    std::uint64_t writer = 0;                       // of its last Join
    const std::optional<wire::Identity>& identity;  // of whoever it is, not of whom it says to be
    std::string label;                              // for people: controller, process and host
    wire::Writer<wire::Admit> admit;
    wire::Writer<wire::Observation> observation;
    wire::Writer<wire::Report> report;
    bool alive = true;
    bool is_known = false;  // its Join was read
    // Of this run.
    std::vector<std::uint32_t> robots{};  // that it asked for
    bool claims = false;                  // and was neither granted nor refused
    lockstep::ResendTimer resend{};
    std::uint32_t times_resent = 0;
    Exchange::Frame frame{};                      // reused: the last one
    std::uint64_t epoch = 0;                      // of the lease that it went to
    std::set<std::string> reported_rejections{};  // reasons that it was told of
    lockstep::AnswerTimes answer_times{};
    std::uint64_t late = 0;  // answers
    std::uint64_t rejected = 0;
    std::uint64_t resent_count = 0;  // frames
    // Of earlier ones.
    bool drove = false;  // so that a new run is a reset to it
  };

  // One experiment's. Under the lock: exchange, leases, error.
  struct Run {
    Run(const description::Experiment& experiment, Simulation& simulation, const RunOptions& options,
        const RunListener& listener, std::uint64_t first_epoch);
    const description::Experiment& experiment;
    Simulation& simulation;
    RunMonitor monitor;
    Exchange exchange;
    lockstep::Leases leases;
    std::string error;
    bool started = false;  // from the first frame on
    std::vector<std::uint32_t> all_robots;
    std::vector<std::uint32_t> undemanding;   // robots that do not require a controller
    std::vector<bool> was_driven;             // by robot, whether somebody drove it in this run
    std::vector<std::uint32_t> descriptions;  // on the wire, by kind
  };

  struct Arrival {
    wire::Join join;
    wire::Sender sender;
    Door* door = nullptr;
  };
  struct Liveliness {
    wire::Sender sender;
    bool alive = false;
  };
  struct Rejections {
    std::string text;  // of the first
    std::uint64_t count = 0;
  };
  // What DDS's threads leave for the thread of `run`.
  struct Inbox {
    std::vector<Arrival> arrivals;
    std::vector<Liveliness> liveliness;
    std::vector<wire::Report> reports;
    std::vector<std::uint32_t> ended_processes;
    std::vector<ReceivedRequest> requests{};
    std::map<std::uint64_t, std::size_t> requests_of{};  // by participant
    std::size_t request_bytes = 0;
    std::vector<wire::Sender> gone_requesters{};
    std::string failure;                                                     // of something outside
    std::set<std::uint32_t> foreign_versions{};                              // of the protocol, that clients have
    std::map<std::pair<std::uint64_t, std::string>, Rejections> rejected{};  // by who, or what participant, and reason
    bool empty() const {
      return arrivals.empty() && liveliness.empty() && reports.empty() && ended_processes.empty() && failure.empty() &&
             foreign_versions.empty() && rejected.empty() && requests.empty() && gone_requesters.empty();
    }
  };

  // On DDS's threads (server_callbacks.cpp).
  void on_join(Door& door, const wire::Join& join, const wire::Sender& sender);
  void on_liveliness(const wire::Sender& sender, bool alive);
  void on_command(const wire::Command& command, const wire::Sender& sender);
  bool take_answer(const wire::Command& command, const wire::Sender& sender);
  void on_report(const wire::Report& report, const wire::Sender& sender);
  void on_foreign_version(std::uint32_t major);
  void on_request(Door& door, const wire::Request& request, const wire::Sender& sender);
  void on_requester(const wire::Sender& sender, bool alive);
  bool is_in_own_name(std::uint64_t client, const wire::Sender& sender) const;
  void reject(std::uint64_t who, const char* reason, std::string_view text);
  void call_attention();

  // On the thread of `run`; those that take the lock must not hold it. One run, tick by tick (server.cpp):
  bool wait_for_controllers(const std::atomic<bool>& stop);
  bool run_tick(const std::atomic<bool>& stop);
  bool fill_frame(std::uint64_t client_id, Client& client, std::uint64_t tick, bool resent);
  void write_frame(std::uint64_t client_id, Client& client, std::uint64_t tick, bool resent);
  void send_frame(std::uint64_t client_id, Client& client, std::uint64_t tick, bool resent);
  void send_frames();
  void resend_frames(Clock::time_point now);
  bool handle_misses(Clock::time_point now);
  Clock::time_point next_wake() const;
  bool is_awaited(std::uint64_t client) const;
  std::vector<std::uint64_t> frames_under_way(const std::vector<std::uint32_t>& robots) const;
  void report_progress(bool now_anyway);
  void publish_world_state();
  void publish_scene(SceneBroadcast::When when);
  std::string error();

  // Control (server_control.cpp):
  bool stand_at_boundary(const std::atomic<bool>& stop);
  void let_recordings_be_fetched();
  SessionSnapshot take_snapshot();
  void fill_status(wire::SimulationStatus& status);
  wire::ControllerStatus status_of(std::uint64_t client_id, Client& client, std::chrono::nanoseconds waiting);
  void note_answers(std::uint64_t client_id, Client& client);
  std::uint64_t due_tick_of(const std::vector<std::uint32_t>& robots) const;

  // Who is attached (server_clients.cpp):
  void handle_inbox();
  void handle_arrival(const Arrival& arrival);
  void handle_liveliness(std::uint64_t client_id, bool alive);
  void handle_rejections(const Inbox& inbox);
  Client* attach(const Arrival& arrival);
  void claim_anew();
  void claim(std::uint64_t client_id, Client& client);
  std::string why_forbidden(const Client& client, const std::set<std::uint32_t>& robots) const;
  void forget(std::uint64_t client_id);
  void refuse(std::uint64_t client_id, Client& client, const std::string& reason);
  void decide_claims();
  void admit(const lockstep::Leases::Granted& granted);
  wire::StartReason why_it_starts(const std::vector<std::uint32_t>& robots, const Client& client) const;
  void see_who_drives();
  void publish_descriptions();
  std::string robots_text(const std::vector<std::uint32_t>& robots) const;
  std::string label_of(std::uint64_t client) const;

  std::uint32_t run_number_ = 0;
  std::uint64_t next_epoch_ = 1;
  std::uint64_t arrivals_ = 0;
  std::unique_ptr<Run> run_;  // set under the lock; null between runs

  std::mutex mutex_;
  std::condition_variable wake_;
  // Under the lock. `participant_of_client_`: who joined under an id; DDS says it, so that nobody can answer in
  // another's name.
  Inbox inbox_;
  bool attention_ = false;  // wake up before the tick is complete
  std::map<std::uint64_t, std::uint64_t> participant_of_client_;

  std::map<std::uint64_t, Client> clients_;                  // by id
  std::map<std::uint64_t, std::uint64_t> client_of_writer_;  // of Join
  std::vector<wire::RobotDescription> descriptions_;         // on the wire so far
  Clock::time_point observers_counted_at_{};
  bool observed_ = false;
  std::vector<double> poses_;  // reused
  LiveRecordings recordings_;
  Control control_{recordings_};

  wire::Writer<wire::WorldState> world_state_;
  SceneBroadcast scenes_;
  // Last, so that no callback comes before all else is there or after it is gone. A list, since they stay where they
  // are.
  std::list<Door> doors_;
};

}  // namespace cohort::session
