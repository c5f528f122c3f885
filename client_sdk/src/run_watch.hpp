// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <mutex>
#include <optional>

#include "client_sdk/src/network_clock.hpp"

namespace cohort {

/// Tells a client whether its current answer is still needed. Thread-safe.
class RunWatch {
 public:
  /// Returns true if the server has ended the run or the lease, or has been away for too long.
  bool is_over() const;

  void note_end();
  void note_server(bool there);

 private:
  mutable std::mutex mutex_;
  bool ended_ = false;
  std::optional<NetworkClock::time_point> away_since_;
};

}  // namespace cohort
