// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "server/recording/replay.hpp"
#include "tools/view/source.hpp"
#include "tools/view/sources/recorded_values.hpp"
#include "tools/view/sources/replay_publisher.hpp"

namespace cohort::view {

/// Shows a recording by replaying its world, at any speed, from any time. All viewers see the same state. Requests:
/// `play`, `pause`, `step` (a number of ticks, also negative), `speed` (0: as fast as possible), `seek` (log time [s])
/// and `history`, which does not affect the shown state.
class RecordingSource final : public Source {
 public:
  /// `recording` and `topics` must outlive this.
  RecordingSource(const recording::Recording& recording, Topics& topics, unsigned threads);
  ~RecordingSource() override;

  void ask(const ViewRequest& request, std::function<void(const Answer&)> answer) override;
  void watch(const std::vector<std::uint32_t>& robots) override;
  void leave(std::uint64_t visitor) override { histories_.leave(visitor); }

 private:
  using Clock = std::chrono::steady_clock;
  using Nanoseconds = std::chrono::nanoseconds;

  // Pending requests. Under the lock.
  struct Wanted {
    bool is_playing = false;
    bool plays_again = false;  // plays from the beginning, if it is at the end
    double speed = 1.0;
    std::optional<Nanoseconds> seek{};
    std::int64_t steps = 0;
    std::vector<std::uint32_t> watched{};
  };

  Answer take(const ViewRequest& request);
  void run();
  void act(const Wanted& wanted);
  bool has_newer_request() const { return requests_ != requests_taken_ || is_stopping_; }
  bool is_interrupted() const { return interruptions_ != interruptions_taken_ || is_stopping_; }
  void go_to(Nanoseconds log_time);
  void step_back(std::int64_t ticks);
  void play(const Wanted& wanted);
  bool advance();
  void show_status(const Wanted& wanted);
  Nanoseconds start_before(Nanoseconds log_time) const;

  const recording::Recording& recording_;
  recording::Replay replay_;
  ReplayPublisher publisher_;
  Topics& topics_;

  std::mutex mutex_;
  std::condition_variable changed_;
  Wanted wanted_;
  std::atomic<std::uint64_t> requests_{0};
  std::atomic<std::uint64_t> interruptions_{0};  // number of requests that end the present action
  std::atomic<bool> is_stopping_{false};

  // State of the thread.
  std::uint64_t requests_taken_ = 0;
  std::uint64_t interruptions_taken_ = 0;
  bool is_at_end_ = false;
  std::string problem_;
  Nanoseconds log_time_{0};
  Nanoseconds step_{0};  // step size of the last world that could be built; a replay may have none
  std::uint64_t state_hash_ = 0;
  Nanoseconds end_{0};
  std::vector<std::uint32_t> watched_;
  // Origin from which the pace is measured.
  struct Pace {
    Clock::time_point wall{};
    Nanoseconds time{0};
    double speed = 0.0;
  };
  std::optional<Pace> pace_;
  Clock::time_point measured_at_{};
  double real_time_factor_ = 0.0;
  std::thread thread_;
  RecordedValues values_;  // for the thread of the histories
  HistoryThread histories_;
};

}  // namespace cohort::view
