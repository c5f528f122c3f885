#include "server/session/server.hpp"

#include <algorithm>
#include <numeric>
#include <thread>

#include "server/session/roster.hpp"

namespace cohort::session {
namespace {

constexpr std::chrono::milliseconds longest_sleep{200};  // `stop` may be set by a signal, which wakes nobody
constexpr std::chrono::milliseconds observer_count_interval{100};
constexpr int answers_kept = 8;  // of each client, by DDS, until they are taken
const std::string view_partition = "view";

}  // namespace

Server::Server(const description::Experiment& experiment, Simulation& simulation, wire::Participant& participant,
               const RunOptions& options, RunListener listener)
    : experiment_(experiment),
      simulation_(simulation),
      participant_(participant),
      book_(experiment, simulation, options, std::move(listener)),
      exchange_(simulation),
      leases_(simulation.robot_count()),
      all_robots_(simulation.robot_count()),
      descriptions_(participant),
      world_state_(participant, view_partition),
      joins_(participant, {[this](const wire::Join& join, const wire::Sender& sender) { on_join(join, sender); },
                           [this](const wire::Sender& sender, bool alive) { on_liveliness(sender, alive); }}),
      commands_(participant,
                {[this](const wire::Command& command, const wire::Sender& sender) { on_command(command, sender); }, {}},
                "", answers_kept),
      reports_(participant,
               {[this](const wire::Report& report, const wire::Sender& sender) { on_report(report, sender); }, {}}) {
  std::iota(all_robots_.begin(), all_robots_.end(), 0u);
  for (const wire::RobotDescription& description : describe_kinds(simulation)) descriptions_.write(description);
}

Server::~Server() = default;

void Server::fail(const std::string& error) {
  const std::lock_guard lock(mutex_);
  if (inbox_.failure.empty()) inbox_.failure = error;
  attention_ = true;
  wake_.notify_all();
}

std::string Server::error() {
  const std::lock_guard lock(mutex_);
  return error_;
}

RunResult Server::run(const std::atomic<bool>& stop) {
  using End = RunResult::End;
  const auto end = [&](End how, const std::string& error = {}) {
    book_.stop();
    handle_inbox();
    end_clients(how, error);
    report_progress(true);
    return book_.finish(how, error);
  };
  const auto end_early = [&] {
    const std::string error = this->error();
    return error.empty() ? end(End::interrupted) : end(End::failed, error);
  };
  if (!wait_for_controllers(stop)) return end_early();
  book_.start();
  running_ = true;
  while (!book_.is_over()) {
    if (!run_tick(stop)) return end_early();
    try {
      simulation_.step();
    } catch (const std::runtime_error& error) {
      book_.add_event("stopped", error.what());
      return end(End::failed, error.what());
    }
    book_.stepped();
    publish_world_state();
    std::this_thread::sleep_until(book_.due_time());
  }
  return end(End::finished);
}

bool Server::wait_for_controllers(const std::atomic<bool>& stop) {
  for (;;) {
    handle_inbox();
    decide_claims();
    report_progress(false);
    std::unique_lock lock(mutex_);
    if (!error_.empty() || stop) return false;
    if (std::ranges::all_of(all_robots_, [&](std::uint32_t robot) { return leases_.holder(robot).has_value(); }))
      return true;
    wake_.wait_for(lock, longest_sleep, [&] { return attention_; });
    attention_ = false;
  }
}

// From boundary k to the complete set of commands for it. False if the run has to end.
bool Server::run_tick(const std::atomic<bool>& stop) {
  handle_inbox();
  decide_claims();
  const Clock::time_point begin = Clock::now();
  {
    const std::lock_guard lock(mutex_);
    exchange_.open(begin.time_since_epoch());
  }
  send_frames();
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_until(lock, next_wake(), [&] { return exchange_.barrier().complete() || attention_; });
      attention_ = false;
      if (!error_.empty() || stop) return false;
      if (exchange_.barrier().complete()) {
        const auto latency = Clock::now() - begin;
        book_.add_barrier(latency);
        median_tick_.add(latency);
        exchange_.apply();
        break;
      }
    }
    const Clock::time_point now = Clock::now();
    handle_inbox();
    decide_claims();
    if (!handle_misses(now)) return false;
    resend_frames(now);
    report_progress(false);
  }
  report_progress(false);
  return true;
}

Server::Clock::time_point Server::next_wake() const {
  Clock::time_point wake = std::min(Clock::now() + longest_sleep, book_.next_report());
  if (const auto deadline = exchange_.barrier().next_deadline()) wake = std::min(wake, Clock::time_point(*deadline));
  for (const auto& [id, client] : clients_)
    if (is_awaited(id)) wake = std::min(wake, Clock::time_point(client.resend.due()));
  return wake;
}

// Under the lock.
bool Server::is_awaited(std::uint64_t client) const {
  const lockstep::Leases::Lease* lease = leases_.lease(client);
  return lease != nullptr &&
         std::ranges::any_of(lease->robots, [&](auto robot) { return exchange_.barrier().is_awaited(robot); });
}

void Server::send_frame(std::uint64_t client_id, Client& client, std::uint64_t tick, bool resent) {
  wire::Observation observation;
  {
    const std::lock_guard lock(mutex_);
    const lockstep::Leases::Lease* lease = leases_.lease(client_id);
    if (lease == nullptr) return;
    exchange_.fill_frame(client.frame, lease->robots, tick);
    observation.epoch = lease->epoch;
  }
  if (client.frame.robots.empty()) return;
  observation.client = client_id;
  observation.run = run_number_;
  observation.resent = resent ? client.times_resent : 0;
  observation.tick = tick;
  observation.time_ns = (experiment_.world.step * static_cast<std::int64_t>(tick)).count();
  observation.robots = client.frame.robots;
  observation.values = client.frame.values;
  client.observation.write(observation);  // lost if DDS cannot take it: sent again then
}

void Server::send_frames() {
  for (auto& [id, client] : clients_) {
    send_frame(id, client, simulation_.tick(), false);
    client.resend.start(Clock::now().time_since_epoch(), median_tick_.value());
    client.times_resent = 0;
  }
}

void Server::resend_frames(Clock::time_point now) {
  for (auto& [id, client] : clients_) {
    if (now.time_since_epoch() < client.resend.due()) continue;
    std::vector<std::uint64_t> ticks;
    {
      const std::lock_guard lock(mutex_);
      if (!is_awaited(id)) continue;
      ticks = frames_under_way(leases_.lease(id)->robots);
    }
    ++client.times_resent;
    for (const std::uint64_t tick : ticks) send_frame(id, client, tick, true);
    client.resend.resent(now.time_since_epoch());
  }
}

bool Server::handle_misses(Clock::time_point now) {
  std::set<std::uint64_t> detached;
  {
    const std::lock_guard lock(mutex_);
    for (const lockstep::Barrier::Miss& miss : exchange_.barrier().expire(now.time_since_epoch())) {
      const auto waited = std::chrono::duration_cast<std::chrono::milliseconds>(miss.waited);
      const std::string text = simulation_.robot_name(miss.robot) + " did not answer tick " +
                               std::to_string(miss.frame_tick) + " within " + std::to_string(waited.count()) + " ms";
      book_.add_event("missed", text);
      book_.add_late();
      if (miss.consequence == description::OnLate::stop && error_.empty()) error_ = text;
      if (const auto holder = leases_.holder(miss.robot); miss.consequence == description::OnLate::detach && holder) {
        leases_.release(*holder);
        detached.insert(*holder);
      }
    }
    if (!error_.empty()) return false;
  }
  for (const std::uint64_t client : detached)
    clients_.at(client).report.write({client, run_number_, wire::ReportKind::superseded, simulation_.tick(), "detached",
                                      "it missed a deadline, and its policy is to detach it"});
  return true;
}

void Server::report_progress(bool now_anyway) {
  book_.report(now_anyway, [&](Progress& progress) {
    const std::lock_guard lock(mutex_);
    std::vector<std::uint32_t> awaited;
    if (running_) {
      awaited = exchange_.barrier().awaited();
      progress.waiting = Clock::now().time_since_epoch() - exchange_.barrier().opened_at();
    } else {
      for (const std::uint32_t robot : all_robots_)
        if (!leases_.holder(robot)) awaited.push_back(robot);
    }
    for (const std::uint32_t robot : awaited) progress.awaited.push_back(simulation_.robot_name(robot));
    if (!awaited.empty())
      if (const auto holder = leases_.holder(awaited.front())) progress.awaited_from = label_of(*holder);
  });
}

void Server::publish_world_state() {
  const Clock::time_point now = Clock::now();
  if (now - observers_counted_at_ > observer_count_interval) {
    observers_counted_at_ = now;
    observed_ = world_state_.matched() > 0;
  }
  if (!observed_) return;
  poses_.clear();
  std::vector<std::uint32_t> present;
  for (const std::uint32_t robot : all_robots_) {
    if (!simulation_.is_present(robot)) continue;
    present.push_back(robot);
    const Pose X_WL = simulation_.robot_pose(robot);
    const auto& p = X_WL.position;
    const auto& q = X_WL.orientation;
    poses_.insert(poses_.end(), {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
  }
  world_state_.write(
      {run_number_, simulation_.tick(), simulation_.time().count(), simulation_.state_hash(), present, poses_});
}

void Server::on_join(const wire::Join& join, const wire::Sender& sender) {
  const std::lock_guard lock(mutex_);
  inbox_.joins.emplace_back(join, sender);
  attention_ = true;
  wake_.notify_all();
}

void Server::on_liveliness(const wire::Sender& sender, bool alive) {
  const std::lock_guard lock(mutex_);
  inbox_.liveliness.push_back({sender, alive});
  attention_ = true;
  wake_.notify_all();
}

void Server::on_report(const wire::Report& report, const wire::Sender& sender) {
  if (report.kind != wire::ReportKind::failed) return;  // a client has nothing else to report
  const std::lock_guard lock(mutex_);
  if (!is_in_own_name(report.client, sender))
    return reject(sender.participant, "foreign", "a Report comes in the name of " + wire::partition_of(report.client));
  inbox_.reports.push_back(report);
  attention_ = true;
  wake_.notify_all();
}

// Under the lock: whether DDS says that this comes from the process that joined under that id.
bool Server::is_in_own_name(std::uint64_t client, const wire::Sender& sender) const {
  const auto joined = participant_of_client_.find(client);
  return joined != participant_of_client_.end() && joined->second == sender.participant;
}

void Server::on_command(const wire::Command& command, const wire::Sender& sender) {
  const std::lock_guard lock(mutex_);
  const lockstep::Leases::Lease* lease = leases_.lease(command.client);
  const std::string answer = "an answer to tick " + std::to_string(command.tick);
  if (lease == nullptr) return reject(command.client, "foreign", "commands come from a client that drives no robot");
  if (!is_in_own_name(command.client, sender))
    return reject(sender.participant, "foreign", "commands come in the name of " + wire::partition_of(command.client));
  if (command.run != run_number_) return reject(command.client, "stale", answer + " of another run");
  if (command.epoch != lease->epoch) return reject(command.client, "stale", answer + " of another lease");

  const Exchange::Taken taken = exchange_.take(lease->robots, command.tick, command.robots, command.values);
  if (taken.accepted > 0) leases_.note_answer(command.client);
  if (taken.rejection) reject(command.client, taken.rejection->reason, taken.rejection->text);
  if (taken.ends_run && error_.empty()) error_ = taken.rejection->text;
  if (exchange_.barrier().complete() || !error_.empty()) wake_.notify_all();
}

// Counted, and told by the thread of `run` when it next looks; a flood must not wake it for each message.
void Server::reject(std::uint64_t client, const std::string& reason, const std::string& text) {
  auto& [first_text, count] = inbox_.rejected[{client, reason}];
  if (count++ == 0) first_text = text;
}

}  // namespace cohort::session
