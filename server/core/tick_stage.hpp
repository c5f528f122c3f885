// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string_view>
#include <vector>

namespace cohort {

/// The wall time that a thread spends in each stage of its ticks. For one thread.
class StageTimes {
 public:
  struct Stage {
    std::string_view name;  ///< lives as long as the program
    std::chrono::nanoseconds time{0};
  };

  /// Ends the present stage and begins another; null: begins none.
  void enter(const char* name) {
    const Clock::time_point now = Clock::now();
    if (present_ < stages_.size()) stages_[present_].time += now - since_;
    since_ = now;
    present_ = name != nullptr ? index_of(name) : none;
  }
  const std::vector<Stage>& stages() const { return stages_; }  ///< in the order in which they first began

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t none = -1;

  std::size_t index_of(std::string_view name) {
    std::size_t index = 0;
    while (index < stages_.size() && stages_[index].name != name) ++index;
    if (index == stages_.size()) stages_.push_back({name});
    return index;
  }

  std::vector<Stage> stages_;
  std::size_t present_ = none;
  Clock::time_point since_;
};

/// The stage of a tick that a thread computes, for a watchdog on another thread. It has no effect on results.
class TickStage {
 public:
  /// Returns the name of the stage; null between ticks.
  const char* name() const { return name_.load(std::memory_order_relaxed); }
  /// Returns the number of ticks, and of requests between ticks, that have begun.
  std::uint64_t begun() const { return begun_.load(std::memory_order_relaxed); }
  /// Measures the stages of all ticks. Call it before the first tick.
  void measure(StageTimes* times) { times_ = times; }

  /// The stage that this thread marks; null without a watchdog.
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a watchdog sets it
  static inline thread_local TickStage* of_this_thread = nullptr;

 private:
  friend class StageMarks;
  StageTimes* times_ = nullptr;
  std::atomic<const char*> name_{nullptr};
  std::atomic<std::uint64_t> begun_{0};  // written by one thread
};

/// Marks the stages of a tick on this thread, until it is destroyed. Without a watchdog, it costs one read of a
/// thread-local pointer, otherwise one store for each stage. Marks may be nested; the outermost ones begin a tick or a
/// request.
class StageMarks {
 public:
  StageMarks() : stage_(TickStage::of_this_thread), before_(stage_ != nullptr ? stage_->name() : nullptr) {
    if (stage_ != nullptr && before_ == nullptr) stage_->begun_.store(stage_->begun() + 1, std::memory_order_relaxed);
  }
  StageMarks(const StageMarks&) = delete;
  StageMarks& operator=(const StageMarks&) = delete;
  ~StageMarks() { enter(before_); }

  /// `name` must live as long as the program.
  void enter(const char* name) {
    if (stage_ == nullptr) return;
    stage_->name_.store(name, std::memory_order_relaxed);
    if (stage_->times_ != nullptr) stage_->times_->enter(name);
  }

 private:
  TickStage* const stage_;
  const char* const before_;
};

}  // namespace cohort
