#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "server/lockstep/latency_histogram.hpp"

namespace cohort::lockstep {

/// How long one client takes from the first sending of a frame to its answer. Frames may overtake each other's answers;
/// of those without an answer the last 64 are remembered.
class AnswerTimes {
 public:
  using Time = std::chrono::nanoseconds;

  /// Ticks ascend. A frame that is sent again counts from its first sending.
  void sent(std::uint64_t tick, Time now) {
    if (!sent_.empty() && sent_.back().first >= tick) return;
    if (sent_.size() == most) sent_.pop_front();
    sent_.emplace_back(tick, now);
  }
  /// Of a frame that is not remembered it is nothing.
  void answered(std::uint64_t tick, Time at) {
    for (auto each = sent_.begin(); each != sent_.end(); ++each) {
      if (each->first != tick) continue;
      histogram_.add(at - each->second);
      sent_.erase(each);
      return;
    }
  }
  const LatencyHistogram& histogram() const { return histogram_; }

 private:
  static constexpr std::size_t most = 64;
  std::deque<std::pair<std::uint64_t, Time>> sent_;
  LatencyHistogram histogram_;
};

}  // namespace cohort::lockstep
