// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "server/run/session_snapshot.hpp"

namespace cohort::session {

/// Snapshots of a run that are kept in memory, so that the run can go back to them. They are taken at regular
/// intervals, which grow when they would take too much memory. Not thread-safe.
class KeptSnapshots {
 public:
  /// Keeps one every `interval` ticks; 0: none.
  KeptSnapshots(std::uint64_t interval, std::size_t most_bytes) : interval_(interval), most_bytes_(most_bytes) {}

  /// Returns true if a snapshot of this tick should be kept.
  bool wants(std::uint64_t tick) const;
  void keep(SessionSnapshot snapshot) { keep(std::make_shared<const SessionSnapshot>(std::move(snapshot))); }
  /// Keeps a snapshot of any tick, such as the one from which the run continues.
  void keep(std::shared_ptr<const SessionSnapshot> snapshot);
  /// Returns the last snapshot at or before `tick`; null if there is none.
  std::shared_ptr<const SessionSnapshot> last_until(std::uint64_t tick) const;
  /// Discards the snapshots after `tick`, because the run continues differently from there.
  void forget_after(std::uint64_t tick);

  /// Returns the current number of ticks between snapshots.
  std::uint64_t interval() const { return interval_; }
  std::size_t size() const { return snapshots_.size(); }
  /// The ticks of the first and the last snapshot; there must be at least one.
  std::uint64_t first_tick() const { return snapshots_.begin()->first; }
  std::uint64_t last_tick() const { return snapshots_.rbegin()->first; }

 private:
  void thin_out();

  std::uint64_t interval_;
  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  std::map<std::uint64_t, std::shared_ptr<const SessionSnapshot>> snapshots_;  // by tick
};

}  // namespace cohort::session
