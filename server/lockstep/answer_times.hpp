// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "server/lockstep/latency_histogram.hpp"

namespace cohort::lockstep {

/// The times of one client from the first sending of a frame to its answer. Answers may arrive out of order; the last
/// 64 unanswered frames are remembered.
class AnswerTimes {
 public:
  using Time = std::chrono::nanoseconds;

  /// Notes a sent frame; ticks ascend. A resent frame counts from its first sending.
  void sent(std::uint64_t tick, Time now) {
    if (!sent_.empty() && sent_.back().first >= tick) return;
    if (sent_.size() == most) sent_.pop_front();
    sent_.emplace_back(tick, now);
  }
  /// Notes an answer; ignored if the frame is not remembered.
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
