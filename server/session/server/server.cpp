#include "server/session/server/server.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "server/session/roster.hpp"

// One run, tick by tick.
namespace cohort::session {
namespace {

constexpr std::chrono::milliseconds longest_sleep{200};  // `stop` may be set by a signal, which wakes nobody
constexpr std::chrono::milliseconds observer_count_interval{100};
const std::string view_partition = "view";

}  // namespace

Server::Run::Run(const description::Experiment& its_experiment, Simulation& its_simulation, const RunOptions& options,
                 const RunListener& listener, std::uint64_t first_epoch)
    : experiment(its_experiment),
      simulation(its_simulation),
      monitor(its_experiment, its_simulation, options, listener),
      exchange(its_simulation),
      leases(its_simulation.robot_count(), first_epoch),
      all_robots(its_simulation.robot_count()),
      was_driven(its_simulation.robot_count()) {
  std::iota(all_robots.begin(), all_robots.end(), 0u);
  std::ranges::copy_if(all_robots, std::back_inserter(undemanding),
                       [&](std::uint32_t robot) { return !its_simulation.policy(robot).required; });
}

Server::Server(std::span<wire::Participant> participants)
    : world_state_(participants.front(), view_partition), scenes_(participants.front(), view_partition) {
  for (wire::Participant& participant : participants) doors_.emplace_back(*this, participant);
}

Server::~Server() = default;

std::string Server::error() {
  const std::lock_guard lock(mutex_);
  return run_->error;
}

RunResult Server::run(const description::Experiment& experiment, Simulation& simulation, const RunOptions& options,
                      const RunListener& listener, const std::atomic<bool>& stop) {
  using End = RunResult::End;
  {
    auto next = std::make_unique<Run>(experiment, simulation, options, recordings_.listening(listener), next_epoch_);
    const std::lock_guard lock(mutex_);
    ++run_number_;
    if (options.from) restore(*options.from, next->exchange);
    run_ = std::move(next);
  }
  Run& run = *run_;
  recordings_.begin(experiment, simulation, options.from != nullptr);
  control_.begin({experiment, simulation, run.monitor, run_number_,
                  [this](wire::SimulationStatus& status) { fill_status(status); }, [this] { return take_snapshot(); }});
  publish_descriptions();
  claim_anew();

  const auto end = [&](End how, const std::string& error = {}) {
    run.monitor.stop();
    handle_inbox();
    report_progress(true);
    const bool goes_on = how == End::reset || how == End::restored;
    if (!goes_on) {
      recordings_.end(how, how == End::finished ? simulation.stop_reason().value_or("") : error);
      let_recordings_be_fetched();
    }
    control_.end(how);
    RunResult result = run.monitor.finish(how, error);
    const std::lock_guard lock(mutex_);
    next_epoch_ = run.leases.next_epoch();
    for (auto& [id, client] : clients_) client.drove = run.leases.lease(id) != nullptr;
    run_.reset();
    return result;
  };
  const auto end_early = [&] {
    const std::string error = this->error();
    if (!error.empty()) return end(End::failed, error);
    if (!control_.ending()) return end(End::interrupted);
    const Control::Ending ending = *control_.ending();
    if (run.started) run.monitor.at_boundary();
    RunResult result = end(ending.how);
    result.next = ending.next;
    return result;
  };
  if (!wait_for_controllers(stop)) return end_early();
  run.monitor.start();
  run.started = true;
  for (;;) {
    if (!stand_at_boundary(stop)) return end_early();
    if (run.monitor.is_over()) break;
    if (!run_tick(stop)) return end_early();
    try {
      simulation.step();
    } catch (const std::runtime_error& error) {
      run.monitor.add_event("stopped", error.what());
      return end(End::failed, error.what());
    }
    run.monitor.stepped();
  }
  publish_world_state();
  publish_scene(SceneBroadcast::When::at_once);
  return end(End::finished);
}

bool Server::wait_for_controllers(const std::atomic<bool>& stop) {
  const auto is_ready = [&](std::uint32_t robot) {
    return run_->leases.holder(robot).has_value() || !run_->simulation.policy(robot).required ||
           run_->exchange.barrier().is_detached(robot);
  };
  for (bool is_new = true;; is_new = false) {
    handle_inbox();
    const bool had_work = control_.has_work();
    if (!control_.perform(Control::Moment::boundary)) return false;
    publish_scene(is_new || had_work ? SceneBroadcast::When::at_once : SceneBroadcast::When::for_newcomers);
    decide_claims();
    report_progress(false);
    std::unique_lock lock(mutex_);
    if (!run_->error.empty() || stop) return false;
    if (std::ranges::all_of(run_->all_robots, is_ready)) return true;
    wake_.wait_for(lock, longest_sleep, [&] { return attention_; });
    attention_ = false;
  }
}

// From boundary k to the complete set of commands for it. False if the run has to end.
bool Server::run_tick(const std::atomic<bool>& stop) {
  decide_claims();
  see_who_drives();
  const Clock::time_point begin = Clock::now();
  {
    const std::lock_guard lock(mutex_);
    run_->exchange.open(begin.time_since_epoch());
  }
  send_frames();
  run_->monitor.at_boundary();
  publish_world_state();
  publish_scene(SceneBroadcast::When::due);
  if (!handle_misses(begin)) return false;
  std::span<const std::uint32_t> changed;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_until(lock, next_wake(), [&] { return run_->exchange.barrier().complete() || attention_; });
      attention_ = false;
      if (!run_->error.empty() || stop) return false;
      if (run_->exchange.barrier().complete()) {
        run_->monitor.add_barrier(Clock::now() - begin);
        changed = run_->exchange.apply();
        break;
      }
    }
    const Clock::time_point now = Clock::now();
    handle_inbox();
    if (!control_.perform(Control::Moment::midst)) return false;
    decide_claims();
    if (!handle_misses(now)) return false;
    resend_frames(now);
    report_progress(false);
  }
  run_->monitor.commanded(changed);
  report_progress(false);
  return true;
}

Server::Clock::time_point Server::next_wake() const {
  Clock::time_point wake = std::min(Clock::now() + longest_sleep, run_->monitor.next_report());
  if (const auto deadline = run_->exchange.barrier().next_deadline())
    wake = std::min(wake, Clock::time_point(*deadline));
  for (const auto& [id, client] : clients_)
    if (is_awaited(id)) wake = std::min(wake, Clock::time_point(client.resend.due()));
  return wake;
}

// Under the lock.
bool Server::is_awaited(std::uint64_t client) const {
  const lockstep::Leases::Lease* lease = run_->leases.lease(client);
  return lease != nullptr &&
         std::ranges::any_of(lease->robots, [&](auto robot) { return run_->exchange.barrier().is_awaited(robot); });
}

// Under the lock: the client's frame of this tick. Whether there is one.
bool Server::fill_frame(std::uint64_t client_id, Client& client, std::uint64_t tick, bool resent) {
  client.frame.robots.clear();
  const lockstep::Leases::Lease* lease = run_->leases.lease(client_id);
  if (lease == nullptr) return false;
  if (!resent) {
    client.resend.note_answer(lease->answered_tick, lease->answered_copy, lease->answered_at);
    note_answers(client_id, client);
  }
  run_->exchange.fill_frame(client.frame, lease->robots, tick);
  client.epoch = lease->epoch;
  return !client.frame.robots.empty();
}

void Server::write_frame(std::uint64_t client_id, Client& client, std::uint64_t tick, bool resent) {
  wire::Observation observation;
  observation.client = client_id;
  observation.run = run_number_;
  observation.resent = resent ? client.times_resent : 0;
  observation.epoch = client.epoch;
  observation.tick = tick;
  observation.time_ns = (run_->experiment.world.step * static_cast<std::int64_t>(tick)).count();
  observation.robots = client.frame.robots;
  observation.values = client.frame.values;
  if (!resent) {
    const lockstep::Time now = Clock::now().time_since_epoch();
    client.resend.start(tick, now);
    client.answer_times.sent(tick, now);
  }
  client.observation.write(observation);  // lost if DDS cannot take it: sent again then
}

void Server::send_frame(std::uint64_t client_id, Client& client, std::uint64_t tick, bool resent) {
  {
    const std::lock_guard lock(mutex_);
    if (!fill_frame(client_id, client, tick, resent)) return;
  }
  write_frame(client_id, client, tick, resent);
}

// All are filled before the first is sent, so that nobody who takes its answers has to wait for the lock.
void Server::send_frames() {
  const std::uint64_t tick = run_->simulation.tick();
  {
    const std::lock_guard lock(mutex_);
    for (auto& [id, client] : clients_) fill_frame(id, client, tick, false);
  }
  for (auto& [id, client] : clients_) {
    if (client.frame.robots.empty()) continue;
    write_frame(id, client, tick, false);
    client.times_resent = 0;
  }
}

void Server::resend_frames(Clock::time_point now) {
  for (auto& [id, client] : clients_) {
    if (!client.resend.is_due(now.time_since_epoch())) continue;
    std::vector<std::uint64_t> ticks;
    {
      const std::lock_guard lock(mutex_);
      if (!is_awaited(id)) continue;
      ticks = frames_under_way(run_->leases.lease(id)->robots);
    }
    ++client.times_resent;
    for (const std::uint64_t tick : ticks) send_frame(id, client, tick, true);
    run_->monitor.add_resent(ticks.size());
    client.resent_count += ticks.size();
    client.resend.resent(now.time_since_epoch());
  }
}

bool Server::handle_misses(Clock::time_point now) {
  std::set<std::uint64_t> detached;
  {
    const std::lock_guard lock(mutex_);
    for (const lockstep::Barrier::Miss& miss : run_->exchange.barrier().expire(now.time_since_epoch())) {
      run_->monitor.add_miss(miss);
      if (const auto holder = run_->leases.holder(miss.robot)) ++clients_.at(*holder).late;
      if (miss.consequence == description::OnLate::stop && run_->error.empty())
        run_->error = run_->simulation.robot_name(miss.robot) + " did not answer tick " +
                      std::to_string(miss.frame_tick) + " within " +
                      std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(miss.waited).count()) +
                      " ms";
      if (const auto holder = run_->leases.holder(miss.robot);
          miss.consequence == description::OnLate::detach && holder) {
        run_->leases.release(*holder);
        detached.insert(*holder);
      }
    }
    if (!run_->error.empty()) return false;
  }
  for (const std::uint64_t client : detached)
    clients_.at(client).report.write({client, run_number_, wire::ReportKind::superseded, run_->simulation.tick(),
                                      "detached", "it missed a deadline, and its policy is to detach it"});
  return true;
}

void Server::report_progress(bool now_anyway) {
  run_->monitor.report(now_anyway, [&](Progress& progress) {
    const std::lock_guard lock(mutex_);
    std::vector<std::uint32_t> awaited;
    progress.paused = control_.holds();
    if (run_->started && !progress.paused) {
      awaited = run_->exchange.barrier().awaited();
      progress.waiting = Clock::now().time_since_epoch() - run_->exchange.barrier().opened_at();
    } else if (!run_->started) {
      for (const std::uint32_t robot : run_->all_robots)
        if (!run_->leases.holder(robot) && run_->simulation.policy(robot).required) awaited.push_back(robot);
    }
    for (const std::uint32_t robot : awaited) progress.awaited.push_back(run_->simulation.robot_name(robot));
    if (!awaited.empty())
      if (const auto holder = run_->leases.holder(awaited.front())) progress.awaited_from = label_of(*holder);
  });
}

void Server::publish_world_state() {
  const Clock::time_point now = Clock::now();
  if (now - observers_counted_at_ > observer_count_interval) {
    observers_counted_at_ = now;
    observed_ = world_state_.matched() > 0;
  }
  if (!observed_) return;
  const Simulation& simulation = run_->simulation;
  poses_.clear();
  std::vector<std::uint32_t> present;
  for (const std::uint32_t robot : run_->all_robots) {
    if (!simulation.is_present(robot)) continue;
    present.push_back(robot);
    const Pose X_WL = simulation.robot_pose(robot);
    const auto& p = X_WL.position;
    const auto& q = X_WL.orientation;
    poses_.insert(poses_.end(), {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
  }
  world_state_.write(
      {run_number_, simulation.tick(), simulation.time().count(), simulation.state_hash(), present, poses_});
}

void Server::publish_scene(SceneBroadcast::When when) {
  scenes_.publish({run_->experiment, run_->simulation, run_number_}, when);
}

}  // namespace cohort::session
