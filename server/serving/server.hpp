#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "server/serving/clients.hpp"
#include "server/serving/control/control.hpp"
#include "server/serving/control/live_recordings.hpp"
#include "server/serving/endpoints.hpp"
#include "server/serving/inbox.hpp"
#include "server/serving/scene_broadcast.hpp"
#include "server/serving/served_run.hpp"
#include "server/serving/world_state_broadcast.hpp"

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

  // On DDS's threads.
  Endpoints::Callbacks callbacks(wire::Participant& participant);
  template <class Add>
  void put_aside(const Add& add);
  void on_report(const wire::Report& report, const wire::Sender& sender);
  void on_state(const wire::ControllerState& state, const wire::Sender& sender);
  void on_command(const wire::Command& command, const wire::Sender& sender);
  bool take_answer(const wire::Command& command, const wire::Sender& sender);
  // On the thread that reads texts of models: control has something to do.
  void note_news();

  // On the thread of `run`; those that take the lock must not hold it.
  void begin_run(const description::Experiment& experiment, Simulation& simulation, const RunOptions& options,
                 const RunListener& listener, const std::atomic<bool>& stop);
  RunResult end_run(RunResult::End how, const std::string& error = {});
  RunResult end_early();
  bool wait_for_controllers(const std::atomic<bool>& stop);
  bool welcome_newcomers();
  bool stand_at_boundary(const std::atomic<bool>& stop);
  bool run_tick(const std::atomic<bool>& stop);
  bool decide_claims();
  void handle_inbox();
  bool give_up_on_late(Clock::time_point now);
  bool note_misses(std::span<const lockstep::Barrier::Miss> misses);
  Clock::time_point next_wake() const;
  void report_progress(bool now_anyway);
  void publish_descriptions();
  void publish_world_state() { world_state_.publish(run_->simulation, run_->number); }
  void publish_scene(SceneBroadcast::When when);
  void let_recordings_be_fetched();
  // For control.
  SessionSnapshot take_snapshot(const std::atomic<bool>& stop);
  ControllerStates gather_states(const std::atomic<bool>& stop);
  void fill_status(wire::SimulationStatus& status);

  std::uint32_t run_number_ = 0;
  std::uint64_t next_epoch_;
  std::unique_ptr<ServedRun> run_;  // set under the lock; null between runs

  std::mutex mutex_;
  std::condition_variable wake_;
  Inbox inbox_;  // under the lock

  Clients clients_{mutex_};
  std::map<std::uint32_t, wire::RobotDescription> descriptions_;  // on the wire so far, by number
  LiveRecordings recordings_;
  Control control_;
  WorldStateBroadcast world_state_;
  SceneBroadcast scenes_;
  // Last, so that no callback comes before all else is there or after it is gone. A list, since they stay where they
  // are.
  std::list<Endpoints> endpoints_;
};

}  // namespace cohort::session
