// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "server/core/tick_stage.hpp"
#include "tools/cli/common/log.hpp"

namespace cohort::tool {

/// Watches the ticks of a run from a separate thread. Warns of a controller in this process that has not returned for
/// 10 s, and of a step that takes over 10 s, with its stage. Ends the process with exit code 1 if it was asked to end,
/// and the present tick takes another 10 s because of a controller or a step. Data recorded before are kept in the
/// file.
class Watchdog {
 public:
  /// `stop`: whether the process was asked to end. `stop` and `log` must outlive this.
  Watchdog(const std::atomic<bool>& stop, Log& log, std::chrono::milliseconds patience = std::chrono::seconds(10));
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  ~Watchdog();

  /// Measures the stages of the ticks; `times` must outlive this.
  void measure(StageTimes& times) { stage_.measure(&times); }
  /// Notes the tick; called at each boundary, on the thread of the run.
  void reached(std::uint64_t tick) {
    tick_ = tick;
    TickStage::of_this_thread = &stage_;
  }

 private:
  void watch();
  void warn_of_call(std::uint64_t tick, const std::string& call);
  void warn_of_stage(std::uint64_t tick, const char* stage);
  [[noreturn]] void end_process(std::uint64_t tick, const std::optional<std::string>& call, const char* stage);
  std::string patience() const;  ///< as text

  const std::atomic<bool>& stop_;
  Log& log_;
  const std::chrono::milliseconds patience_;
  TickStage stage_;
  std::atomic<std::uint64_t> tick_{0};
  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace cohort::tool
