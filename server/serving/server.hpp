// SPDX-License-Identifier: Apache-2.0
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

/// Runs experiments whose controllers are DDS clients; the server's side of docs/protocol.md. Clients stay attached
/// from one run to the next. DDS callbacks store control messages and take answers at once, under one lock. All else
/// happens on the thread of `run`, which alone creates and destroys entities and steps the world.
class Server {
 public:
  /// `participants`: at least one; one for each served DDS domain, or with security one for each identity in each
  /// domain. They must outlive this object. A client may be in any of them; observers are in the first.
  explicit Server(std::span<wire::Participant> participants);
  ~Server();

  /// Waits for a controller for every robot that requires one, then runs. Clients that are already attached are
  /// admitted to the new run if their selectors match robots of it. Returns soon after `stop` is set, even while it
  /// waits, or when a client ends or restarts the run. Experiment and simulation need to outlive only this call.
  RunResult run(const description::Experiment& experiment, Simulation& simulation, const RunOptions& options,
                const RunListener& listener, const std::atomic<bool>& stop);

  /// Tells all clients that drive robots that no further run follows and how the last one ended. Waits a short time
  /// until they have left.
  void dismiss(const RunResult& last);

  /// Ends the run with this error, unless a controller has reported one before. For any thread.
  void fail(const std::string& error);
  /// Notes that a process of this machine has ended: the client in it counts as dead, even before DDS liveliness
  /// reports it. For any thread.
  void note_process_end(std::uint32_t process);

 private:
  using Clock = RunMonitor::Clock;

  // Functions for DDS's threads.
  Endpoints::Callbacks callbacks(wire::Participant& participant);
  template <class Add>
  void put_aside(const Add& add);
  void on_report(const wire::Report& report, const wire::Sender& sender);
  void on_state(const wire::ControllerState& state, const wire::Sender& sender);
  void on_command(const wire::Command& command, const wire::Sender& sender);
  bool take_answer(const wire::Command& command, const wire::Sender& sender);
  // Called on the thread that reads model texts: the control has work.
  void note_news();

  // Functions for the thread of `run`; those that take the lock must be called without it.
  void begin_run(const description::Experiment& experiment, Simulation& simulation, const RunOptions& options,
                 const RunListener& listener, const std::atomic<bool>& stop);
  RunResult end_run(RunResult::End how, const std::string& error = {});
  RunResult end_early();
  bool wait_for_controllers(const std::atomic<bool>& stop);
  bool welcome_newcomers();
  void note_lateness(Clock::time_point due);
  bool show_held_run(bool may_have_changed);
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
  // Callbacks for the control.
  SessionSnapshot take_snapshot(const std::atomic<bool>& stop);
  ControllerStates gather_states(const std::atomic<bool>& stop);
  void fill_status(wire::SimulationStatus& status);

  std::uint32_t run_number_ = 0;
  std::uint64_t next_epoch_;
  std::unique_ptr<ServedRun> run_;  // set under the lock; null between runs

  std::mutex mutex_;
  std::condition_variable wake_;
  Inbox inbox_;  // guarded by the lock

  Clients clients_{mutex_};
  std::map<std::uint32_t, wire::RobotDescription> descriptions_;  // published so far, by id
  LiveRecordings recordings_;
  Control control_;
  WorldStateBroadcast world_state_;
  SceneBroadcast scenes_;
  // Last, so that all other members outlive every callback. A list, as the elements must not move.
  std::list<Endpoints> endpoints_;
};

}  // namespace cohort::session
