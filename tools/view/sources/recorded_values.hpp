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
/// Commands are in every recording, and observations in one that was asked to have them: those are read from the file.
/// Otherwise the recording is replayed, apart from the replay that is shown. That takes time, so an answer may be only
/// a first part, and the next request, from `next` on, continues the same replay.
///
/// One replay of the whole recording, the sweep, keeps a reduced history of all values of the robots that are asked
/// for. Their other values are then there at once. Only a request with a finer resolution is replayed again, from the
/// last snapshot before it.
///
/// Times are log times, as those of the time bar. A commanded value is the one with which the robot has come to that
/// time, as in `/cohort/robots`.
class RecordedValues {
 public:
  /// `recording` must outlive this.
  explicit RecordedValues(const recording::Recording& recording);
  ~RecordedValues();

  /// For one thread. If a part cannot be read, the answer has the part before it, and says why.
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
  std::vector<Nanoseconds> rosters_;                          // their log times
  std::map<std::uint32_t, std::string> names_;                // names of robots, by id
  std::map<std::uint32_t, std::vector<std::string>> values_;  // names of all values of robots, by id
  std::optional<recording::Replay> replay_;                   // at a boundary, to be continued
  struct Sweep;
  std::unique_ptr<Sweep> sweep_;
};

}  // namespace cohort::view
