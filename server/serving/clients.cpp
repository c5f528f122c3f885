// SPDX-License-Identifier: Apache-2.0
#include "server/serving/clients.hpp"

#include <algorithm>

#include "client_sdk/src/this_process.hpp"

namespace cohort::session {

void Clients::begin(ServedRun& run) {
  run_ = &run;
  std::vector<AttachedClient*> staying;
  std::vector<std::uint64_t> gone;
  for (auto& [id, client] : clients_) {
    if (!client.alive)
      gone.push_back(id);
    else if (client.drove || client.claims)
      staying.push_back(&client);
    client.begin_run();
  }
  for (const std::uint64_t id : gone) forget(id);
  std::ranges::sort(staying, {}, &AttachedClient::place);
  for (AttachedClient* client : staying) claim(*client, Arriving::in_a_former_run);
}

void Clients::end() {
  for (auto& [id, client] : clients_) client.drove = run_->leases.lease(id) != nullptr;
  run_ = nullptr;
}

std::set<std::uint64_t> Clients::dismiss(const RunResult& last, std::uint32_t run) {
  const bool failed = last.end == RunResult::End::failed;
  const wire::ReportKind kind = failed ? wire::ReportKind::failed : wire::ReportKind::finished;
  const std::string reason = failed ? "failed" : last.end == RunResult::End::finished ? "complete" : "interrupted";
  std::set<std::uint64_t> hearing;
  for (auto& [id, client] : clients_) {
    if (!client.drove) continue;
    client.send(client.report, wire::Report{id, run, kind, last.ticks, reason, last.error}, nullptr);
    if (client.alive) hearing.insert(id);
  }
  return hearing;
}

void Clients::join(const Inbox::Arrival& arrival) {
  AttachedClient* client = attach(arrival);
  if (client == nullptr) return;
  const bool is_news = !client->is_known || client->join.robots != arrival.join.robots;
  client->is_known = true;
  const std::vector<std::string> before = std::exchange(client->join, arrival.join).robots;
  set_alive(*client, true);
  // Clients repeat their Join once a second as a sign of life.
  bool has_lease = false;
  if (is_news) {
    const std::lock_guard lock(mutex_);
    has_lease = run_->leases.lease(client->id()) != nullptr;
  }
  if (has_lease && client->has_growing_lease())
    note_more_selectors(*client, before);
  else if (is_news)
    claim(*client, Arriving::now);
  some_want_more_ |= !client->more.empty();
}

// Returns the client of this Join, with its writers. Null if it may not or cannot be attached.
AttachedClient* Clients::attach(const Inbox::Arrival& arrival) {
  const std::uint64_t id = arrival.join.client;
  std::string refusal;
  {
    const std::lock_guard lock(mutex_);
    refusal = names_.enter(id, arrival.sender, arrival.participant->identity());
  }
  if (refusal.empty()) {
    if (const auto known = clients_.find(id); known != clients_.end()) return &known->second;
    try {
      return &clients_.try_emplace(id, arrival, ++arrivals_).first->second;
    } catch (const wire::WireError& error) {
      refusal = std::string("flood: a client cannot be attached: ") + error.what();
      forget(id);
    }
  }
  run_->monitor.add_event("rejected", refusal);
  return nullptr;
}

void Clients::note_liveliness(const Inbox::Liveliness& change) {
  std::optional<std::uint64_t> id;
  {
    const std::lock_guard lock(mutex_);
    id = client_of(change.sender);
  }
  // Only the writer of the last Join counts: a client that was lost and found again has a new writer, and the end of
  // the old one is reported late.
  if (id) set_alive(clients_.at(*id), change.alive);
}

void Clients::note_process_end(std::uint32_t process) {
  static const std::string here = host_name();
  for (auto next = clients_.begin(); next != clients_.end();) {
    AttachedClient& client = (next++)->second;  // may be erased below
    if (client.join.process == process && client.join.host == here) set_alive(client, false);
  }
}

void Clients::set_alive(AttachedClient& client, bool alive) {
  client.alive = alive;
  {
    const std::lock_guard lock(mutex_);
    names_.set_gone(client.id(), !alive);
    if (const lockstep::Leases::Lease* lease = run_->leases.lease(client.id())) {
      if (lease->alive == alive) return;
      run_->leases.set_alive(client.id(), alive);
      run_->monitor.add_event(alive ? "back" : "lost", client.label + ", the controller of " +
                                                           run_->robots_text(lease->robots) +
                                                           (alive ? ", is back" : ", is gone or does not respond"));
      // The run does not wait for a robot that does not require its controller.
      for (const std::uint32_t robot : lease->robots)
        if (!alive && !run_->simulation.policy(robot).required) run_->exchange.barrier().set_driven(robot, false);
      return;
    }
    if (client.claims) {
      // A claim counts only while its client is alive; a stopped process that continues gets it back.
      if (alive) run_->leases.claim(client.id(), client.robots);
      if (!alive) run_->leases.release(client.id());
      return;
    }
  }
  if (!alive) forget(client.id());
}

void Clients::forget(std::uint64_t client) {
  clients_.erase(client);
  const std::lock_guard lock(mutex_);
  names_.forget(client);
}

void Clients::tell(AttachedClient& client, wire::ReportKind kind, const std::string& reason, const std::string& text,
                   std::optional<std::uint64_t> tick) {
  const std::uint64_t of_tick = tick.value_or(run_->simulation.tick());
  client.send(client.report, wire::Report{client.id(), run_->number, kind, of_tick, reason, text}, run_);
}

void Clients::note_rejections(const Inbox::Rejected& rejected) {
  for (const auto& [key, rejections] : rejected) {
    const auto& [id, reason] = key;
    // Such answers are expected after a frame was resent.
    const bool is_repeat = reason == "repeated" || reason == "stale";
    if (is_repeat)
      run_->monitor.add_repeated(rejections.count);
    else
      run_->monitor.add_event("rejected", reason + " from " + label_of(id) + ": " + rejections.text, rejections.count);
    const auto found = clients_.find(id);
    if (found == clients_.end()) continue;
    AttachedClient& client = found->second;
    client.rejected += rejections.count;
    if (is_repeat) continue;
    if (client.reported_rejections.insert(reason).second)
      tell(client, wire::ReportKind::rejected, reason, rejections.text, rejections.tick);
  }
}

bool Clients::refuse_unfit(const wire::Report& report) {
  const auto found = clients_.find(report.client);
  if (report.reason != wire::failed_in_start || found == clients_.end()) return false;
  AttachedClient& client = found->second;
  std::string teams;
  {
    const std::lock_guard lock(mutex_);
    const lockstep::Leases::Lease* lease = run_->leases.lease(report.client);
    if (lease == nullptr || lease->answer_count > 0) return false;
    teams = run_->teams_text(lease->robots);
    for (const std::uint32_t robot : lease->robots)
      if (!run_->simulation.policy(robot).required) run_->exchange.barrier().set_driven(robot, false);
    for (const std::uint32_t robot : client.drives_first) run_->was_driven[robot] = false;
    run_->leases.release(report.client);
  }
  client.refuse(*run_, {wire::AdmitStatus::failed_in_start, teams + ": " + report.text});
  return true;
}

// All frames are filled in before the first is sent, so that threads that receive answers need not wait for the lock.
void Clients::send_frames() {
  const std::uint64_t tick = run_->simulation.tick();
  {
    const std::lock_guard lock(mutex_);
    for (auto& [id, client] : clients_) client.fill_frame(*run_, tick, false);
  }
  for (auto& [id, client] : clients_) {
    if (client.frame.robots.empty()) continue;
    client.write_frame(*run_, tick, false);
    client.times_resent = 0;
  }
}

void Clients::send_frame(AttachedClient& client, std::uint64_t tick, bool resent) {
  {
    const std::lock_guard lock(mutex_);
    client.fill_frame(*run_, tick, resent);
  }
  if (!client.frame.robots.empty()) client.write_frame(*run_, tick, resent);
}

void Clients::resend_frames(RunMonitor::Clock::time_point now) {
  for (auto& [id, client] : clients_) {
    if (!client.resend.is_due(now.time_since_epoch())) continue;
    std::vector<std::uint64_t> ticks;
    {
      const std::lock_guard lock(mutex_);
      if (!run_->is_awaited(id)) continue;
      ticks = run_->frames_under_way(run_->leases.lease(id)->robots);
    }
    resend_frames(client, ticks, now.time_since_epoch());
  }
}

void Clients::resend_frames(AttachedClient& client, std::span<const std::uint64_t> ticks, lockstep::Time now) {
  ++client.times_resent;
  for (const std::uint64_t tick : ticks) send_frame(client, tick, true);
  run_->monitor.add_resent(ticks.size());
  client.resent_count += ticks.size();
  client.resend.resent(now);
}

RunMonitor::Clock::time_point Clients::next_resend(RunMonitor::Clock::time_point latest) const {
  for (const auto& [id, client] : clients_)
    if (run_->is_awaited(id)) latest = std::min(latest, RunMonitor::Clock::time_point(client.resend.due()));
  return latest;
}

void Clients::tell_detached(std::uint64_t client) {
  tell(clients_.at(client), wire::ReportKind::superseded, "detached",
       "it missed a deadline or gave an invalid answer, and its policy is 'detach'");
}

std::vector<wire::ControllerStatus> Clients::status() {
  std::vector<wire::ControllerStatus> all;
  for (auto& [id, client] : clients_)
    if (run_->leases.lease(id) != nullptr) all.push_back(client.status(*run_));
  return all;
}

std::string Clients::label_of(std::uint64_t client) const {
  const auto found = clients_.find(client);
  return found == clients_.end() ? "an unknown client" : found->second.label;
}

}  // namespace cohort::session
