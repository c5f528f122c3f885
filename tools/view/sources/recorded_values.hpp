// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "server/recording/replay.hpp"
#include "tools/view/history/history_collector.hpp"
#include "tools/view/history/history_thread.hpp"

namespace cohort::view {

/// Values of robots over the time of a recording.
///
/// Every recording contains commands, and contains observations if these were requested: both are read from the file.
/// Other values come from a replay, separate from the replay that is shown. Because this takes time, an answer may be
/// only a first part; the next request, from `next` on, continues the same replay.
///
/// One replay of the whole recording, the sweep, keeps a reduced history of all values of the requested robots. Later
/// requests for other values of these robots are therefore answered at once. Only a request with a finer resolution
/// needs another replay, from the last snapshot before its interval.
///
/// Times are log times, as in the time bar. A commanded value is the one that was in effect during the tick before that
/// time, as in `/cohort/robots`.
class RecordedValues {
 public:
  /// `recording` must outlive this.
  explicit RecordedValues(const recording::Recording& recording);
  ~RecordedValues();

  /// Returns the requested values. If a part cannot be read, the answer contains the values before it, and says why.
  /// Not thread-safe.
  Answer read(const HistoryRequest& request, const HistoryThread::IsCancelled& is_cancelled);

 private:
  using Nanoseconds = std::chrono::nanoseconds;

  void read_rosters();
  bool may_have(const HistoryRequest& request) const;
  bool are_recorded(const HistoryRequest& request) const;
  Answer read_records(const HistoryRequest& request, const HistoryThread::IsCancelled& is_cancelled) const;
  bool is_as_coarse_as_sweep(const HistoryRequest& request) const;
  Answer sweep(const HistoryRequest& request, const HistoryThread::IsCancelled& is_cancelled);
  void begin_sweep(const HistoryRequest& request);
  Answer replay(const HistoryRequest& request, const HistoryThread::IsCancelled& is_cancelled);
  void start_before(Nanoseconds time);

  const recording::Recording& recording_;
  Nanoseconds end_{0};
  bool has_rosters_ = false;
  std::vector<Nanoseconds> rosters_;                          // log times of rosters
  std::map<std::uint32_t, std::string> names_;                // names of robots, by id
  std::map<std::uint32_t, std::vector<std::string>> values_;  // names of all values of robots, by id
  std::optional<recording::Replay> replay_;                   // at a boundary, to be continued
  struct Sweep;
  std::unique_ptr<Sweep> sweep_;
};

}  // namespace cohort::view
