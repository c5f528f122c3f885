// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/kept_snapshots.hpp"

#include <iterator>
#include <utility>

namespace cohort::session {
namespace {

std::size_t size_of(const SessionSnapshot& snapshot) {
  std::size_t size =
      sizeof snapshot + snapshot.experiment.size() + snapshot.simulation.size() + snapshot.exchange.size();
  for (const auto& state : snapshot.controllers)
    size += sizeof state + (state ? state->controller.size() + state->bytes.size() : 0);
  return size;
}

}  // namespace

bool KeptSnapshots::wants(std::uint64_t tick) const {
  return interval_ != 0 && tick % interval_ == 0 && !snapshots_.contains(tick);
}

void KeptSnapshots::keep(std::shared_ptr<const SessionSnapshot> snapshot) {
  bytes_ += size_of(*snapshot);
  snapshots_[snapshot->tick] = std::move(snapshot);
  while (bytes_ > most_bytes_ && snapshots_.size() > 1) thin_out();
}

// Drops every other snapshot, so that the run can still go back to ticks of its whole duration.
void KeptSnapshots::thin_out() {
  interval_ *= 2;
  std::erase_if(snapshots_, [this](const auto& each) {
    const bool goes = each.first % interval_ != 0;
    if (goes) bytes_ -= size_of(*each.second);
    return goes;
  });
}

std::shared_ptr<const SessionSnapshot> KeptSnapshots::last_until(std::uint64_t tick) const {
  const auto after = snapshots_.upper_bound(tick);
  return after == snapshots_.begin() ? nullptr : std::prev(after)->second;
}

void KeptSnapshots::forget_after(std::uint64_t tick) {
  for (auto each = snapshots_.upper_bound(tick); each != snapshots_.end(); each = snapshots_.erase(each))
    bytes_ -= size_of(*each->second);
}

}  // namespace cohort::session
