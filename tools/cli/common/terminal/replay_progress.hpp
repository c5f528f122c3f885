// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <chrono>

#include "tools/cli/common/log.hpp"

namespace cohort::tool {

/// The progress of reading a recording, shown several times per second.
class ReplayProgress {
 public:
  explicit ReplayProgress(Log& log) : log_(log) {}

  /// `what`: the activity, such as `replayed`.
  void at(std::chrono::nanoseconds log_time, const char* what) {
    constexpr std::chrono::milliseconds interval{200};
    const auto now = std::chrono::steady_clock::now();
    if (!log_.rewrites_progress() || now - last_ < interval) return;
    last_ = now;
    log_.progress(fmt::format("{:8.2f} s {}", std::chrono::duration<double>(log_time).count(), what));
  }

 private:
  Log& log_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace cohort::tool
