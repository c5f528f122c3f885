// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "server/serving/server.hpp"

namespace cohort::session {

SessionSnapshot Server::take_snapshot(const std::atomic<bool>& stop) {
  ControllerStates controllers = gather_states(stop);
  SessionSnapshot snapshot;
  {
    const std::lock_guard lock(mutex_);
    snapshot = session::take_snapshot(run_->experiment, run_->simulation, run_->exchange, std::move(controllers));
  }
  run_->monitor.note_left_out(snapshot);
  return snapshot;
}

// Collects the states at a boundary. Meanwhile the inbox is read, but no request is carried out.
ControllerStates Server::gather_states(const std::atomic<bool>& stop) {
  if (!run_->started) {
    const auto& from = run_->monitor.options().from;
    return from ? from->controllers : ControllerStates();
  }
  constexpr std::chrono::milliseconds longest_nap{5};
  clients_.begin_states();
  while (clients_.gather_states(Clock::now()) && !stop) {
    {
      std::unique_lock lock(mutex_);
      if (!run_->error.empty()) throw SnapshotError(run_->error);
      wake_.wait_for(lock, longest_nap, [&] { return inbox_.has_news(); });
    }
    handle_inbox();
  }
  return clients_.end_states();
}

}  // namespace cohort::session
