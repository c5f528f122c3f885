// SPDX-License-Identifier: Apache-2.0

// The part of Clients for claims of robots, and the leases that result from them.

#include <algorithm>
#include <set>
#include <stdexcept>

#include "server/description/select_robots.hpp"
#include "server/run/roster.hpp"
#include "server/serving/clients.hpp"

namespace cohort::session {
namespace {

// Limits of a client's requests, so that no client can use up the time of a tick.
constexpr std::size_t most_selectors = 4096;
constexpr std::size_t most_without_robots = 64;

std::string too_many_selectors() {
  return "the client requests more than " + std::to_string(most_selectors) + " selectors; use ranges";
}

}  // namespace

void Clients::note_more_selectors(AttachedClient& client, const std::vector<std::string>& before) {
  const std::set<std::string> now(client.join.robots.begin(), client.join.robots.end());
  std::set<std::string> more(client.more.begin(), client.more.end());
  std::erase_if(more, [&](const std::string& selector) { return !now.contains(selector); });
  more.insert(now.begin(), now.end());
  for (const std::string& selector : before)
    if (std::ranges::find(client.more, selector) == client.more.end()) more.erase(selector);
  client.more.assign(more.begin(), more.end());
  if (client.join.robots.size() <= most_selectors) return;
  client.more.clear();
  run_->monitor.add_event("refused", client.label + " gets no more robots: " + too_many_selectors());
}

// Returns the robots that match any of the selectors, and leaves those that match none, at most `most_mismatches`.
// `mismatch`: why the first of them does not.
std::set<std::uint32_t> Clients::take_matching(std::vector<std::string>& selectors, std::size_t most_mismatches,
                                               std::string& mismatch) const {
  std::set<std::uint32_t> robots;
  std::size_t mismatches = 0;
  std::erase_if(selectors, [&](const std::string& selector) {
    if (mismatches > most_mismatches) return true;
    try {
      const auto selected = description::select_robots(run_->simulation.description(), selector);
      robots.insert(selected.begin(), selected.end());
      return true;
    } catch (const std::invalid_argument& error) {
      if (mismatch.empty()) mismatch = error.what();
      return ++mismatches > most_mismatches;
    }
  });
  return robots;
}

// Claims the robots of this run that match the client's selectors. Robots that were added to a former run are not in
// this one.
void Clients::claim(AttachedClient& client, Arriving arriving) {
  const bool may_lack_robots = arriving == Arriving::in_a_former_run && client.has_growing_lease();
  std::set<std::uint32_t> robots;
  std::string mismatch;
  std::vector<std::string> selectors = client.join.robots;
  if (selectors.size() > most_selectors)
    return client.refuse(*run_, {wire::AdmitStatus::too_many_selectors, too_many_selectors()});
  robots = take_matching(selectors, may_lack_robots ? most_without_robots : 0, mismatch);
  if (may_lack_robots && !robots.empty()) {
    client.more = std::move(selectors);
    mismatch.clear();
  }
  if (robots.empty() && mismatch.empty()) mismatch = "the client requests no robot";
  if (!mismatch.empty()) return client.refuse(*run_, {wire::AdmitStatus::unknown_robot, mismatch});
  if (const std::string forbidden = why_forbidden(client, robots); !forbidden.empty())
    return client.refuse(*run_, {wire::AdmitStatus::not_permitted, forbidden});
  client.robots.assign(robots.begin(), robots.end());
  client.claims = true;
  const std::lock_guard lock(mutex_);
  run_->leases.claim(client.id(), client.robots);
}

// Returns an empty text if the client's identity may drive all these robots, or if there is no security.
std::string Clients::why_forbidden(const AttachedClient& client, const std::set<std::uint32_t>& robots) const {
  if (!client.identity) return {};
  const std::vector<std::string>& selectors = client.identity->robots;
  const std::string who = "its identity '" + client.identity->name + "' may ";
  if (selectors.empty()) return who + "observe, but not drive robots";
  // The same identities may be used with several experiments, so this one need not have all their robots.
  const auto allowed = description::select_robots_of_any(run_->simulation.description(), selectors);
  const auto forbidden =
      std::ranges::find_if(robots, [&](std::uint32_t robot) { return !std::ranges::binary_search(allowed, robot); });
  if (forbidden == robots.end()) return {};
  std::string list;
  for (const std::string& selector : selectors) list += (list.empty() ? "" : ",") + selector;
  return who + "drive " + list + ", not " + run_->simulation.robot_name(*forbidden);
}

void Clients::decide_claims() {
  extend_leases();
  lockstep::Leases::Decisions decisions;
  {
    const std::lock_guard lock(mutex_);
    if (!run_->leases.has_claims()) return;
    const lockstep::Barrier& barrier = run_->exchange.barrier();
    const bool at_boundary = barrier.complete();
    decisions =
        run_->leases.decide(RunMonitor::Clock::now().time_since_epoch(), [&](const std::vector<std::uint32_t>& robots) {
          return at_boundary || std::ranges::any_of(robots, [&](auto robot) { return barrier.is_awaited(robot); });
        });
  }
  for (const auto& refused : decisions.refused)
    clients_.at(refused.client)
        .refuse(*run_, {wire::AdmitStatus::robot_taken,
                        run_->simulation.robot_name(refused.robot) + " is driven by " + label_of(refused.holder)});
  for (const auto& granted : decisions.granted) admit(granted);
}

// Between the frames of two ticks, adds robots to the leases of clients that have requested more.
void Clients::extend_leases() {
  if (!some_want_more_) return;
  {
    const std::lock_guard lock(mutex_);
    if (!run_->exchange.barrier().complete()) return;
  }
  some_want_more_ = false;
  for (auto& [id, client] : clients_)
    if (!client.more.empty()) extend(client);
}

// Adds only robots that no client has driven: others may have controllers with state, and unanswered frames.
void Clients::extend(AttachedClient& client) {
  std::string mismatch;
  std::set<std::uint32_t> robots = take_matching(client.more, most_without_robots, mismatch);
  std::vector<std::uint64_t> frames;
  wire::Admit answer;
  {
    const std::lock_guard lock(mutex_);
    if (run_->leases.lease(client.id()) == nullptr) return;
    std::erase_if(robots, [&](auto robot) {
      return run_->was_driven[robot] || run_->leases.holder(robot) || run_->is_gone(robot);
    });
    if (const std::string refusal = why_forbidden(client, robots); !refusal.empty()) {
      run_->monitor.add_event("refused", client.label + " gets no more robots: " + refusal);
      return;
    }
    if (robots.empty()) return;
    const std::vector<std::uint32_t> added(robots.begin(), robots.end());
    for (const std::uint32_t robot : run_->leases.lease(client.id())->robots)
      if (!run_->is_gone(robot)) robots.insert(robot);
    run_->leases.change(client.id(), {robots.begin(), robots.end()});
    const lockstep::Leases::Lease& lease = *run_->leases.lease(client.id());
    client.robots = lease.robots;
    client.drives_first.insert(client.drives_first.end(), added.begin(), added.end());
    for (const std::uint32_t robot : added) run_->was_driven[robot] = true;
    frames = frames_under_way(lease);
    answer = admission(client, lease);
    answer.start_reason = wire::StartReason::more_robots;
    answer.tick = frames.empty() ? run_->simulation.tick() : frames.front();
    run_->monitor.add_event("joined", client.label + " also drives " + run_->robots_text(added));
  }
  client.send(client.admit, answer, run_);
  for (const std::uint64_t tick : frames) send_frame(client, tick, false);
  client.times_resent = 0;
}

// Returns an Admit without the reason and the tick. Requires the lock.
wire::Admit Clients::admission(AttachedClient& client, const lockstep::Leases::Lease& lease) {
  wire::Admit answer;
  answer.client = client.id();
  answer.run = run_->number;
  answer.epoch = lease.epoch;
  answer.step_ns = run_->experiment.world.step.count();
  admit_robots(answer, run_->simulation.experiment(), run_->simulation, lease.robots);
  for (wire::AdmittedRobot& robot : answer.robots) robot.description = run_->descriptions[robot.description];
  return answer;
}

// Requires the lock. A restored run may have unanswered frames before its first tick.
std::vector<std::uint64_t> Clients::frames_under_way(const lockstep::Leases::Lease& lease) const {
  const bool has_frames = run_->started || run_->monitor.options().from;
  return has_frames ? run_->frames_under_way(lease.robots) : std::vector<std::uint64_t>();
}

void Clients::admit(const lockstep::Leases::Granted& granted) {
  AttachedClient& client = clients_.at(granted.client);
  for (const std::uint64_t loser : granted.superseded) {
    const std::string text = client.label + " has taken over the robots of this client";
    tell(clients_.at(loser), wire::ReportKind::superseded, "superseded", text);
    run_->monitor.add_event("superseded", label_of(loser) + ": " + text);
  }

  std::vector<std::uint64_t> frames;  // unanswered frames of the robots' previous controllers
  wire::Admit answer;
  {
    const std::lock_guard lock(mutex_);
    const lockstep::Leases::Lease& lease = *run_->leases.lease(granted.client);
    frames = frames_under_way(lease);
    answer = admission(client, lease);
    answer.start_reason = why_it_starts(lease.robots, client);
    if (answer.start_reason == wire::StartReason::takeover && note_lost_state(client, lease.robots)) return;
    if (answer.start_reason == wire::StartReason::restored && give_state(client, lease.robots))
      answer.start_reason = wire::StartReason::restored_with_state;
    if (!granted.again) client.drives_first.clear();
    for (const std::uint32_t robot : lease.robots) {
      if (!run_->was_driven[robot]) client.drives_first.push_back(robot);
      run_->was_driven[robot] = true;
    }
    answer.tick = frames.empty() ? run_->simulation.tick() : frames.front();
    if (!granted.again) run_->monitor.add_event("joined", client.label + " drives " + run_->robots_text(lease.robots));
  }
  client.claims = false;
  client.send(client.admit, answer, run_);
  for (const std::uint64_t tick : frames) send_frame(client, tick, false);
  client.times_resent = 0;
}

// Requires the lock.
wire::StartReason Clients::why_it_starts(const std::vector<std::uint32_t>& robots, const AttachedClient& client) const {
  const auto& from = run_->monitor.options().from;
  // The state in a snapshot is valid at its tick, so it also serves a client that takes over robots at that tick.
  if (from && from->tick == run_->simulation.tick()) return wire::StartReason::restored;
  const bool takes_over = std::ranges::any_of(robots, [&](auto robot) { return run_->was_driven[robot]; });
  if (run_->started && takes_over) return wire::StartReason::takeover;
  return client.drove ? wire::StartReason::reset : wire::StartReason::first;
}

// Returns true if the run goes back because of the lost state. Requires the lock.
bool Clients::note_lost_state(const AttachedClient& client, const std::vector<std::uint32_t>& robots) {
  const bool is_unwanted = std::ranges::any_of(
      robots, [&](auto robot) { return run_->simulation.policy(robot).on_lost == description::OnLost::rewind; });
  const std::string lost =
      "the state of the controllers of " + run_->robots_text(robots) + " was lost when their process ended";
  if (is_unwanted && run_->can_rewind && run_->can_rewind()) {
    run_->rewinds_for = lost;
    return true;
  }
  run_->monitor.add_event("forgotten", lost + "; " + client.label + " starts them without state" +
                                           (is_unwanted ? ", as there is no snapshot to go back to" : ""));
  return false;
}

// Returns true if the initial snapshot of the run has state for the client. Requires the lock.
bool Clients::give_state(AttachedClient& client, std::span<const std::uint32_t> robots) {
  const std::vector<RobotState> states = states_of(*run_->monitor.options().from, robots);
  if (states.empty()) return false;
  if (client.has_state()) {
    client.state.to_load = pack(states);
    return true;
  }
  run_->monitor.add_event(
      "unsaved",
      client.label + " starts without state: it does not load the controller state that the snapshot contains");
  return false;
}

}  // namespace cohort::session
