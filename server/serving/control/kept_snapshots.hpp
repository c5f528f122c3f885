#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>

#include "server/run/session_snapshot.hpp"

namespace cohort::session {

/// Snapshots of a run that are kept in memory, so that it can go back to them: one every so often, less often when they
/// would take too much. Not thread-safe.
class KeptSnapshots {
 public:
  /// One every `interval` ticks; 0: none.
  KeptSnapshots(std::uint64_t interval, std::size_t most_bytes) : interval_(interval), most_bytes_(most_bytes) {}

  /// Whether one of this tick is wanted.
  bool wants(std::uint64_t tick) const;
  void keep(SessionSnapshot snapshot);
  /// The last one at or before `tick`; null if there is none.
  std::shared_ptr<const SessionSnapshot> last_until(std::uint64_t tick) const;
  /// Forgets those after `tick`: what came then is not what will.
  void forget_after(std::uint64_t tick);

  /// Ticks from one to the next, as it is now.
  std::uint64_t interval() const { return interval_; }
  std::size_t size() const { return snapshots_.size(); }
  /// Of the first and the last one; there has to be one.
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
