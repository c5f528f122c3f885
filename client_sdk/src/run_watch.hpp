#pragma once

#include <chrono>
#include <mutex>
#include <optional>

namespace cohort {

/// Whether anybody still wants the answer that a client is working on. Any thread.
class RunWatch {
 public:
  /// Returns whether the server has ended the run or the lease, or has been away for too long.
  bool is_over() const;

  void note_end();
  void note_server(bool there);

 private:
  mutable std::mutex mutex_;
  bool ended_ = false;
  std::optional<std::chrono::steady_clock::time_point> away_since_;
};

}  // namespace cohort
