#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "tools/cohort/cli/log.hpp"

namespace cohort::tool {

/// Ends the process where it stands when it has been asked to end and a tick does not: a controller in it that loops,
/// or a world that takes its time. Says so, with exit code 1; what was recorded before is in its file.
class Watchdog {
 public:
  /// `stop`: whether the process was asked to end. Both must outlive this.
  Watchdog(const std::atomic<bool>& stop, Log& log);
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  ~Watchdog();

  /// At each boundary.
  void reached(std::uint64_t tick) { tick_ = tick; }

 private:
  void watch();

  const std::atomic<bool>& stop_;
  Log& log_;
  std::atomic<std::uint64_t> tick_{0};
  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace cohort::tool
