// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "idl/text/printable.hpp"
#include "server/serving/clients.hpp"

namespace cohort::session {

void Clients::begin_states() {
  const lockstep::Time now = RunMonitor::Clock::now().time_since_epoch();
  const std::lock_guard lock(mutex_);
  for (auto& [id, client] : clients_) {
    client.state.end();
    if (const auto* lease = run_->leases.lease(id); lease != nullptr && lease->alive && client.has_state())
      client.state.begin(lease->robots.size(), now);
  }
}

bool Clients::gather_states(RunMonitor::Clock::time_point at) {
  const lockstep::Time now = at.time_since_epoch();
  bool is_under_way = false;
  for (auto& [id, client] : clients_) {
    if (!client.state.is_under_way()) continue;
    std::vector<std::uint64_t> frames;
    {
      const std::lock_guard lock(mutex_);
      const lockstep::Leases::Lease* lease = run_->leases.lease(id);
      if (lease == nullptr || !lease->alive || client.state.is_silent(now)) {
        client.state.give_up();
        continue;
      }
      client.epoch = lease->epoch;
      frames = run_->frames_under_way(lease->robots);
    }
    is_under_way = true;
    if (frames.empty())
      client.state.note_answers();
    else if (client.resend.is_due(now))
      resend_frames(client, frames, now);
    if (auto question = client.state.question(now)) {
      question->tick = run_->simulation.tick();
      client.send_state(*question, *run_);
    }
  }
  return is_under_way;
}

void Clients::take_states(const Inbox::States& states) {
  const lockstep::Time now = RunMonitor::Clock::now().time_since_epoch();
  for (const auto& [key, message] : states) {
    const auto found = clients_.find(message.head.client);
    if (found == clients_.end()) continue;
    AttachedClient& client = found->second;
    {
      const std::lock_guard lock(mutex_);
      const lockstep::Leases::Lease* lease = run_->leases.lease(client.id());
      if (lease == nullptr || message.head.run != run_->number || message.head.epoch != lease->epoch) continue;
      client.epoch = lease->epoch;
    }
    if (message.head.kind == wire::StateKind::wanted) {
      wire::ControllerState part = part_of(client.state.to_load, message.head.offset);
      part.tick = message.head.tick;
      client.send_state(part, *run_);
    } else if (message.head.tick != run_->simulation.tick()) {
      continue;
    } else if (message.head.kind == wire::StateKind::unsaved) {
      const std::string why(message.data.begin(), message.data.end());
      client.state.note_unsaved(printable(why, Inbox::longest_text));
    } else {
      try {
        client.state.take(message, now);
      } catch (const StateError& error) {
        refuse_state(client, error.what());
      }
    }
  }
}

void Clients::refuse_state(AttachedClient& client, const std::string& why) {
  client.state.give_up();
  ++client.rejected;
  run_->monitor.add_event("rejected", "malformed from " + client.label + ": the state of its controllers: " + why);
}

// Returns the reasons of all controllers that cannot save; empty if there are none.
std::string Clients::note_unsaved() {
  std::string all;
  for (auto& [id, client] : clients_) {
    if (client.state.phase() != StateTransfer::Phase::unsaved) continue;
    std::string teams;
    {
      const std::lock_guard lock(mutex_);
      if (const auto* lease = run_->leases.lease(id)) teams = run_->teams_text(lease->robots);
    }
    const std::string why = teams + ": " + client.state.why_unsaved();
    run_->monitor.add_unsaved(client.label, why);
    all += (all.empty() ? "" : "; ") + why;
  }
  return all;
}

ControllerStates Clients::end_states() {
  ControllerStates states(run_->simulation.robot_count());
  const auto& from = run_->monitor.options().from;
  // A client that drove no robot has no state of one.
  for (std::uint32_t robot = 0; robot < states.size(); ++robot)
    if (!run_->was_driven[robot])
      states[robot] = from && robot < from->controllers.size() ? from->controllers[robot] : ControllerState{};
  for (auto& [id, client] : clients_) {
    if (client.state.phase() != StateTransfer::Phase::done) continue;
    try {
      std::vector<std::uint32_t> robots;
      {
        const std::lock_guard lock(mutex_);
        if (const auto* lease = run_->leases.lease(id)) robots = lease->robots;
      }
      std::vector<RobotState> saved = unpack(client.state.bytes());
      for (const auto& [robot, state] : saved)
        if (!std::ranges::binary_search(robots, robot))
          throw StateError("robot " + std::to_string(robot) + " is not driven by this client");
      for (auto& [robot, state] : saved) {
        if (state) state->controller = printable(state->controller, longest_controller_name);
        states[robot] = std::move(state);
      }
    } catch (const StateError& error) {
      refuse_state(client, error.what());
    }
  }
  const std::string unsaved = note_unsaved();
  for (auto& [id, client] : clients_) client.state.end();
  if (!unsaved.empty()) throw SnapshotError(unsaved);
  return states;
}

}  // namespace cohort::session
