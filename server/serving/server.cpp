// SPDX-License-Identifier: Apache-2.0
#include "server/serving/server.hpp"

#include <algorithm>
#include <random>
#include <set>

#include "server/run/roster.hpp"
#include "server/run/run_recorder.hpp"

namespace cohort::session {
namespace {

constexpr std::chrono::milliseconds longest_sleep{200};  // a signal may set `stop` without waking any thread
constexpr std::chrono::seconds farewell{2};
const std::string view_partition = "view";

// Returns the epoch of a server's first lease: its start in microseconds since 1970. The lowest bits are random, as
// clocks can go back, and machines without a battery start at the same time again.
std::uint64_t first_epoch() {
  constexpr std::uint64_t random_bits = 1023;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto start = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  return (static_cast<std::uint64_t>(start) & ~random_bits) | (std::random_device()() & random_bits);
}

}  // namespace

Server::Server(std::span<wire::Participant> participants)
    : next_epoch_(first_epoch()),
      control_(recordings_, [this] { note_news(); }),
      world_state_(participants.front(), view_partition),
      scenes_(participants.front(), view_partition) {
  for (wire::Participant& participant : participants) endpoints_.emplace_back(participant, callbacks(participant));
}

Server::~Server() = default;

RunResult Server::run(const description::Experiment& experiment, Simulation& simulation, const RunOptions& options,
                      const RunListener& listener, const std::atomic<bool>& stop) {
  begin_run(experiment, simulation, options, listener, stop);
  if (!wait_for_controllers(stop)) return end_early();
  RunMonitor& monitor = run_->monitor;
  monitor.start();
  run_->started = true;
  for (;;) {
    if (!stand_at_boundary(stop)) return end_early();
    if (monitor.is_over()) break;
    if (!run_tick(stop)) return end_early();
    try {
      simulation.step();
    } catch (const std::runtime_error& error) {
      monitor.add_event("stopped", error.what());
      return end_run(RunResult::End::failed, error.what());
    }
    monitor.stepped();
  }
  publish_world_state();
  publish_scene(SceneBroadcast::When::at_once);
  return end_run(RunResult::End::finished);
}

void Server::begin_run(const description::Experiment& experiment, Simulation& simulation, const RunOptions& options,
                       const RunListener& listener, const std::atomic<bool>& stop) {
  auto next = std::make_unique<ServedRun>(experiment, simulation, options, recordings_.listening(listener),
                                          ++run_number_, next_epoch_);
  if (options.from) restore(*options.from, next->exchange);
  {
    const std::lock_guard lock(mutex_);
    run_ = std::move(next);
  }
  recordings_.begin(experiment, simulation, options.from != nullptr);
  control_.begin({experiment, simulation, run_->monitor, run_number_,
                  [this](wire::SimulationStatus& status) { fill_status(status); },
                  [this, &stop] { return take_snapshot(stop); }});
  run_->can_rewind = [this] { return control_.can_rewind(); };
  if (options.from) run_->monitor.note_left_out(*options.from);
  if (!options.rewound.empty()) run_->monitor.add_event("rewound", options.rewound);
  publish_descriptions();
  clients_.begin(*run_);
}

RunResult Server::end_run(RunResult::End how, const std::string& error) {
  ServedRun& run = *run_;
  run.monitor.stop();
  handle_inbox();
  report_progress(true);
  const bool goes_on = how == RunResult::End::reset || how == RunResult::End::restored;
  if (!goes_on) {
    recordings_.end(how, how == RunResult::End::finished ? run.simulation.stop_reason().value_or("") : error);
    let_recordings_be_fetched();
  }
  control_.end(how);
  RunResult result = run.monitor.finish(how, error);
  const std::lock_guard lock(mutex_);
  next_epoch_ = run.leases.next_epoch();
  clients_.end();
  run_.reset();
  return result;
}

RunResult Server::end_early() {
  std::string error;
  std::vector<lockstep::Barrier::Miss> refused;
  {
    const std::lock_guard lock(mutex_);
    error = run_->error;
    refused = run_->exchange.barrier().take_refused();
  }
  note_misses(refused);
  if (!error.empty()) return end_run(RunResult::End::failed, error);
  if (run_->started) run_->monitor.at_boundary();  // the last one, of which no frames may have been sent
  if (!control_.ending()) return end_run(RunResult::End::interrupted);
  const Control::Ending ending = *control_.ending();
  RunResult result = end_run(ending.how);
  result.next = ending.next;
  return result;
}

bool Server::wait_for_controllers(const std::atomic<bool>& stop) {
  for (bool is_new = true;; is_new = false) {
    handle_inbox();
    const bool had_work = control_.has_work();
    if (!control_.perform(Control::Moment::boundary)) return false;
    welcome_newcomers();
    publish_scene(is_new || had_work ? SceneBroadcast::When::at_once : SceneBroadcast::When::for_newcomers);
    clients_.decide_claims();
    report_progress(false);
    std::unique_lock lock(mutex_);
    if (!run_->error.empty() || stop) return false;
    if (run_->is_ready()) return true;
    wake_.wait_for(lock, longest_sleep, [&] { return inbox_.has_news(); });
  }
}

// Adds robots that joined at a boundary. Returns true if one of them lacks a required controller.
bool Server::welcome_newcomers() {
  bool has_newcomers = false;
  bool lacks_controllers = false;
  {
    const std::lock_guard lock(mutex_);
    has_newcomers = run_->add_newcomers();
    lacks_controllers = run_->started && !run_->undriven_newcomers().empty();
  }
  if (has_newcomers) publish_descriptions();
  return lacks_controllers;
}

// A run at a pace is late by so much at the boundary before a tick, but for the first.
void Server::note_lateness(Clock::time_point due) {
  if (run_->monitor.speed() > 0.0 && run_->simulation.tick() > 0) run_->monitor.add_lateness(Clock::now() - due);
}

// Publishes the state of a run that is held, since no tick will, if it may have changed. Returns false if the run has
// to end.
bool Server::show_held_run(bool may_have_changed) {
  if (may_have_changed) publish_world_state();
  publish_scene(may_have_changed ? SceneBroadcast::When::at_once : SceneBroadcast::When::for_newcomers);
  if (!decide_claims()) return false;
  report_progress(false);
  return true;
}

// Carries out requests at the boundary before a tick. Waits while the run is paused or ahead of its pace, or while a
// new robot lacks a required controller. Returns false if the run has to end.
bool Server::stand_at_boundary(const std::atomic<bool>& stop) {
  RunMonitor& monitor = run_->monitor;
  control_.reach_boundary();
  bool was_held = false;
  for (;;) {
    handle_inbox();
    const bool had_work = control_.has_work();
    if (!control_.perform(Control::Moment::boundary)) return false;
    if (monitor.is_over()) return true;
    const bool lacks_controllers = welcome_newcomers();
    std::optional<Clock::time_point> go_on_at;
    if (!lacks_controllers && !control_.holds()) go_on_at = monitor.due_time().value_or(Clock::time_point::min());
    if (go_on_at && Clock::now() >= *go_on_at) {
      note_lateness(*go_on_at);
      return true;
    }
    if (control_.holds() || lacks_controllers) {
      if (!show_held_run(!was_held || had_work)) return false;
      was_held = true;
    }
    std::unique_lock lock(mutex_);
    if (!run_->error.empty() || stop) return false;
    const Clock::time_point until = Clock::now() + longest_sleep;
    wake_.wait_until(lock, go_on_at ? std::min(*go_on_at, until) : until, [&] { return inbox_.has_news(); });
  }
}

// Runs from boundary k until all its commands are complete. Returns false if the run has to end.
bool Server::run_tick(const std::atomic<bool>& stop) {
  if (!decide_claims()) return false;
  const Clock::time_point opened_at = Clock::now();
  {
    const std::lock_guard lock(mutex_);
    run_->see_who_drives();
    run_->exchange.open(opened_at.time_since_epoch());
  }
  clients_.send_frames();
  control_.grant_time();
  run_->monitor.at_boundary();
  publish_world_state();
  publish_scene(SceneBroadcast::When::due);
  if (!give_up_on_late(opened_at)) return false;
  std::vector<lockstep::Barrier::Miss> refused;
  const auto is_complete = [&] { return run_->exchange.barrier().complete() && !control_.holds_time(); };
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_until(lock, next_wake(), [&] { return is_complete() || inbox_.has_news(); });
      if (!run_->error.empty() || stop) return false;
      if (is_complete()) {
        run_->monitor.add_barrier(Clock::now() - opened_at);
        refused = run_->exchange.barrier().take_refused();
        break;
      }
    }
    const Clock::time_point now = Clock::now();
    handle_inbox();
    if (!control_.perform(Control::Moment::midst) || !decide_claims()) return false;
    if (!give_up_on_late(now)) return false;
    control_.grant_time();
    clients_.resend_frames(now);
    report_progress(false);
  }
  if (!note_misses(refused)) return false;
  std::span<const std::uint32_t> changed;
  {
    const std::lock_guard lock(mutex_);
    changed = run_->exchange.apply();
  }
  run_->monitor.commanded(changed);
  report_progress(false);
  return true;
}

// Returns false if the run goes back because the state of a controller is lost.
bool Server::decide_claims() {
  clients_.decide_claims();
  if (run_->rewinds_for.empty()) return true;
  control_.rewind(run_->rewinds_for);
  return false;
}

// Requires the lock.
Server::Clock::time_point Server::next_wake() const {
  Clock::time_point wake = std::min(Clock::now() + longest_sleep, run_->monitor.next_report());
  if (const auto deadline = run_->exchange.barrier().next_deadline())
    wake = std::min(wake, Clock::time_point(*deadline));
  return clients_.next_resend(wake);
}

void Server::handle_inbox() {
  Inbox::Contents inbox;
  {
    const std::lock_guard lock(mutex_);
    inbox = inbox_.take();
  }
  for (const Inbox::Arrival& arrival : inbox.arrivals) clients_.join(arrival);
  for (const Inbox::Liveliness& change : inbox.liveliness) clients_.note_liveliness(change);
  for (const std::uint32_t process : inbox.ended_processes) clients_.note_process_end(process);
  for (const wire::Report& report : inbox.reports) {
    if (clients_.refuse_unfit(report)) continue;
    const std::lock_guard lock(mutex_);
    if (run_->leases.lease(report.client) == nullptr)
      continue;  // it drives no robot, so its failure does not concern the run
    run_->monitor.add_event("failed", clients_.label_of(report.client) + ": " + report.text);
    run_->fail(report.text);
  }
  if (!inbox.failure.empty()) {
    const std::lock_guard lock(mutex_);
    run_->fail(inbox.failure);
  }
  for (const std::uint32_t major : inbox.foreign_versions)
    run_->monitor.add_event("version",
                            "a client uses version " + std::to_string(major) +
                                " of the protocol, but this server uses version 1, so they cannot connect. Install the "
                                "same major version of Cohort on both sides");
  clients_.note_rejections(inbox.rejected);
  clients_.take_states(inbox.states);
  for (const wire::Sender& sender : inbox.gone_requesters) control_.lose(sender);
  for (const ReceivedRequest& received : inbox.requests) control_.take(received);
}

bool Server::give_up_on_late(Clock::time_point now) {
  std::vector<lockstep::Barrier::Miss> late;
  {
    const std::lock_guard lock(mutex_);
    late = run_->exchange.barrier().expire(now.time_since_epoch());
  }
  return note_misses(late);
}

bool Server::note_misses(std::span<const lockstep::Barrier::Miss> misses) {
  using std::chrono::milliseconds;
  if (misses.empty()) return true;
  std::set<std::uint64_t> detached;
  {
    const std::lock_guard lock(mutex_);
    for (const lockstep::Barrier::Miss& miss : misses) {
      run_->monitor.add_miss(miss);
      const auto holder = run_->leases.holder(miss.robot);
      if (holder) clients_.note_miss(*holder);
      if (miss.consequence == description::OnLate::stop)
        run_->fail(run_->simulation.robot_name(miss.robot) + " did not answer tick " + std::to_string(miss.frame_tick) +
                   " within " + std::to_string(std::chrono::duration_cast<milliseconds>(miss.waited).count()) + " ms");
      if (holder && miss.consequence == description::OnLate::detach) {
        run_->leases.release(*holder);
        detached.insert(*holder);
      }
    }
    if (!run_->error.empty()) return false;
  }
  for (const std::uint64_t client : detached) clients_.tell_detached(client);
  return true;
}

void Server::report_progress(bool now_anyway) {
  run_->monitor.report(now_anyway, [&](Progress& progress) {
    const std::lock_guard lock(mutex_);
    progress.paused = control_.holds();
    if (!progress.paused) progress.waiting = run_->waiting();
    const std::vector<std::uint32_t> awaited = run_->awaited(progress.paused);
    for (const std::uint32_t robot : awaited) progress.awaited.push_back(run_->simulation.robot_name(robot));
    if (!awaited.empty())
      if (const auto holder = run_->leases.holder(awaited.front())) progress.awaited_from = clients_.label_of(*holder);
    if (awaited.empty() && run_->started && !progress.paused && control_.holds_time()) {
      progress.awaited.emplace_back("the client that holds the time");
      progress.awaited_from = control_.time_holder();
    }
  });
}

// Publishes the descriptions of the kinds of robots. An id is never reused, as clients keep the descriptions of earlier
// runs.
void Server::publish_descriptions() {
  run_->descriptions.clear();
  for (wire::RobotDescription& kind : describe_kinds(run_->simulation)) {
    kind.description = number_of(kind);
    const auto is_same = [&](const wire::RobotDescription& other) {
      return other.model == kind.model && other.observation == kind.observation && other.command == kind.command &&
             other.tree == kind.tree;
    };
    auto known = descriptions_.find(kind.description);
    while (known != descriptions_.end() && !is_same(known->second)) known = descriptions_.find(++kind.description);
    run_->descriptions.push_back(kind.description);
    if (known != descriptions_.end()) continue;
    for (Endpoints& endpoints : endpoints_) {
      endpoints.trees.write({kind.description, kind.tree});
      endpoints.descriptions.write(kind);
    }
    descriptions_.emplace(kind.description, std::move(kind));
  }
}

void Server::publish_scene(SceneBroadcast::When when) { scenes_.publish({run_->simulation, run_->number}, when); }

// Waits until the recordings of the ended run are fetched, but not for idle clients.
void Server::let_recordings_be_fetched() {
  constexpr std::chrono::seconds longest_idle{2};
  std::uint64_t fetched = recordings_.fetched();
  for (Clock::time_point since = Clock::now(); !recordings_.are_fetched() && Clock::now() - since < longest_idle;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, longest_sleep, [&] { return inbox_.has_news(); });
    }
    handle_inbox();
    if (std::exchange(fetched, recordings_.fetched()) != fetched) since = Clock::now();
  }
}

void Server::fill_status(wire::SimulationStatus& status) {
  constexpr std::size_t most_names = 20;
  const std::lock_guard lock(mutex_);
  status.started = run_->started;
  const std::vector<std::uint32_t> awaited = run_->awaited(control_.holds());
  status.awaited_count = static_cast<std::uint32_t>(awaited.size());
  for (std::size_t i = 0; i < std::min(awaited.size(), most_names); ++i)
    status.awaited.push_back(run_->simulation.robot_name(awaited[i]));
  if (awaited.empty() && run_->started && !control_.holds() && control_.holds_time())
    status.awaited.push_back("the client that holds the time: " + control_.time_holder());
  if (!status.awaited.empty()) status.waiting_ns = run_->waiting().count();
  status.controllers = clients_.status();
}

// Messages that are not delivered before the participant is destroyed are lost, hence the wait.
void Server::dismiss(const RunResult& last) {
  std::string why = last.end == RunResult::End::finished ? last.stop_reason : last.error;
  if (why != last.unrecorded) why += (why.empty() || last.unrecorded.empty() ? "" : ". ") + last.unrecorded;
  scenes_.end(word_of(last.end), why);
  std::set<std::uint64_t> staying = clients_.dismiss(last, run_number_);
  const Clock::time_point until = Clock::now() + farewell;
  std::unique_lock lock(mutex_);
  while (!staying.empty() && Clock::now() < until) {
    wake_.wait_until(lock, until, [&] { return inbox_.has_liveliness(); });
    for (const Inbox::Liveliness& change : inbox_.take_liveliness())
      if (const auto client = clients_.client_of(change.sender); client && !change.alive) staying.erase(*client);
  }
}

}  // namespace cohort::session
