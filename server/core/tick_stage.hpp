#pragma once

#include <atomic>
#include <cstdint>

namespace cohort {

/// The stage of a tick that a thread computes, for a watchdog on another thread. It has no effect on results.
class TickStage {
 public:
  /// Returns the name of the stage; null between ticks.
  const char* name() const { return name_.load(std::memory_order_relaxed); }
  /// Returns how many ticks, or requests between ticks, have begun.
  std::uint64_t begun() const { return begun_.load(std::memory_order_relaxed); }

  /// The stage that this thread marks; null without a watchdog.
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a watchdog sets it
  static inline thread_local TickStage* of_this_thread = nullptr;

 private:
  friend class StageMarks;
  std::atomic<const char*> name_{nullptr};
  std::atomic<std::uint64_t> begun_{0};  // written by one thread
};

/// Marks the stages of a tick on this thread, until it is destroyed. Costs one look at a thread-local pointer without a
/// watchdog, and otherwise a store for each stage. Marks may be nested; the outermost ones begin a tick or a request.
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
    if (stage_ != nullptr) stage_->name_.store(name, std::memory_order_relaxed);
  }

 private:
  TickStage* const stage_;
  const char* const before_;
};

}  // namespace cohort
