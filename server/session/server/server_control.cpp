#include <algorithm>

#include "server/session/server/server.hpp"

// Control: what of it concerns those who drive robots, and where the run stands still for it.
namespace cohort::session {
namespace {

constexpr std::chrono::milliseconds longest_sleep{200};  // `stop` may be set by a signal, which wakes nobody
constexpr std::size_t most_names = 20;
// Of requests between two looks at them.
constexpr std::size_t most_requests = 1024;
constexpr std::size_t most_request_bytes = std::size_t{64} << 20;
constexpr std::size_t largest_request = std::size_t{4} << 20;

std::size_t size_of(const wire::Request& request) {
  return sizeof request + request.label.size() + request.filter.size() + request.entity.size() + request.uri.size() +
         request.resource_string.size() + request.link.size() + request.data.size();
}

}  // namespace

// On a thread of DDS.
void Server::on_request(Door& door, const wire::Request& request, const wire::Sender& sender) {
  const std::size_t bytes = size_of(request);
  const std::lock_guard lock(mutex_);
  if (bytes > largest_request) return reject(sender.participant, "malformed", "a Request is larger than 4 MiB");
  std::size_t& of_sender = inbox_.requests_of[sender.participant];
  if (of_sender >= wire::requests_under_way || inbox_.requests.size() >= most_requests ||
      inbox_.request_bytes + bytes > most_request_bytes)
    return reject(sender.participant, "flood", "more Requests than can be read");
  ++of_sender;
  inbox_.request_bytes += bytes;
  inbox_.requests.push_back({request, sender, &door.participant});
  call_attention();
}

void Server::on_requester(const wire::Sender& sender, bool alive) {
  if (alive) return;
  const std::lock_guard lock(mutex_);
  inbox_.gone_requesters.push_back(sender);
  call_attention();
}

// At the boundary before a tick: does what was asked for, and waits while the run is paused or ahead of its pace. False
// if the run has to end.
bool Server::stand_at_boundary(const std::atomic<bool>& stop) {
  control_.reach_boundary();
  const auto due = [&] {
    return control_.holds() ? std::nullopt : std::optional(run_->monitor.due_time().value_or(Clock::time_point::min()));
  };
  bool was_held = false;
  for (;;) {
    handle_inbox();
    const bool had_work = control_.has_work();
    if (!control_.perform(Control::Moment::boundary)) return false;
    if (run_->monitor.is_over()) return true;
    const auto go_on_at = due();
    if (go_on_at && Clock::now() >= *go_on_at) {
      if (run_->monitor.speed() > 0.0 && run_->simulation.tick() > 0) run_->monitor.add_lateness(Clock::now() - *go_on_at);
      return true;
    }
    if (control_.holds()) {
      if (!was_held || had_work) publish_world_state();  // no tick is about to
      publish_scene(was_held && !had_work ? SceneBroadcast::When::for_newcomers : SceneBroadcast::When::at_once);
      was_held = true;
      decide_claims();
      report_progress(false);
    }
    std::unique_lock lock(mutex_);
    if (!run_->error.empty() || stop) return false;
    const Clock::time_point until = Clock::now() + longest_sleep;
    wake_.wait_until(lock, go_on_at ? std::min(*go_on_at, until) : until, [&] { return attention_; });
    attention_ = false;
  }
}

// The run has ended. Whoever fetches nothing is not waited for.
void Server::let_recordings_be_fetched() {
  constexpr std::chrono::seconds longest_idle{2};
  std::uint64_t fetched = recordings_.fetched();
  for (Clock::time_point since = Clock::now(); !recordings_.are_fetched() && Clock::now() - since < longest_idle;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, longest_sleep, [&] { return attention_; });
      attention_ = false;
    }
    handle_inbox();
    if (std::exchange(fetched, recordings_.fetched()) != fetched) since = Clock::now();
  }
}

SessionSnapshot Server::take_snapshot() {
  const std::lock_guard lock(mutex_);
  return session::take_snapshot(run_->experiment, run_->simulation, run_->exchange);
}

void Server::fill_status(wire::SimulationStatus& status) {
  const std::lock_guard lock(mutex_);
  const lockstep::Barrier& barrier = run_->exchange.barrier();
  status.started = run_->started;
  std::vector<std::uint32_t> awaited;
  const std::chrono::nanoseconds waiting =
      run_->started ? Clock::now().time_since_epoch() - barrier.opened_at() : std::chrono::nanoseconds(0);
  if (run_->started && !control_.holds()) {
    awaited = barrier.awaited();
  } else if (!run_->started) {
    for (const std::uint32_t robot : run_->all_robots)
      if (!run_->leases.holder(robot) && run_->simulation.policy(robot).required) awaited.push_back(robot);
  }
  status.awaited_count = static_cast<std::uint32_t>(awaited.size());
  for (const std::uint32_t robot : awaited) {
    if (status.awaited.size() == most_names) break;
    status.awaited.push_back(run_->simulation.robot_name(robot));
  }
  if (!awaited.empty()) status.waiting_ns = waiting.count();
  for (auto& [id, client] : clients_)
    if (run_->leases.lease(id) != nullptr) status.controllers.push_back(status_of(id, client, waiting));
}

// Under the lock: of one that drives robots.
wire::ControllerStatus Server::status_of(std::uint64_t client_id, Client& client, std::chrono::nanoseconds waiting) {
  note_answers(client_id, client);
  const lockstep::Leases::Lease& lease = *run_->leases.lease(client_id);
  const lockstep::LatencyHistogram& times = client.answer_times.histogram();
  wire::ControllerStatus status;
  status.label = client.label;
  status.client = client_id;
  status.robots = lease.robots;
  status.alive = lease.alive;
  status.awaited = run_->started && is_awaited(client_id);
  status.awaited_ns = status.awaited ? waiting.count() : 0;
  status.due_tick = due_tick_of(lease.robots);
  status.answers = lease.answer_count;
  status.late = client.late;
  status.rejected = client.rejected;
  status.resent = client.resent_count;
  status.answer_p50_ns = times.quantile(0.5).count();
  status.answer_p99_ns = times.quantile(0.99).count();
  return status;
}

// Under the lock.
void Server::note_answers(std::uint64_t client_id, Client& client) {
  run_->leases.drain_news(client_id, [&](const auto& news) { client.answer_times.answered(news.tick, news.at); });
}

// Under the lock: of the oldest frame without an answer, or of the next one.
std::uint64_t Server::due_tick_of(const std::vector<std::uint32_t>& robots) const {
  if (run_->started)
    if (const auto frames = frames_under_way(robots); !frames.empty()) return frames.front();
  const std::uint64_t now = run_->simulation.tick();
  std::optional<std::uint64_t> next;
  for (const std::uint32_t robot : robots) {
    const description::Policy& policy = run_->simulation.policy(robot);
    const std::uint64_t from = run_->started ? now + 1 : now;
    const std::uint64_t after = from <= policy.phase ? 0 : (from - policy.phase + policy.period - 1) / policy.period;
    const std::uint64_t tick = policy.phase + after * policy.period;
    next = std::min(next.value_or(tick), tick);
  }
  return next.value_or(now);
}

}  // namespace cohort::session
