// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "tools/common/processes/children.hpp"

namespace cohort::bench {

/// Client processes of `cohort-bench lockstep`, and their CPU time. The destructor ends them.
class BenchProcesses {
 public:
  /// `arguments` are those of each process after `cohort-bench client`. `failed` is called if a process ends before
  /// `may_end`.
  BenchProcesses(const std::vector<std::vector<std::string>>& arguments,
                 std::function<void(const std::string&)> failed);

  /// Allows the processes to end from now on.
  void may_end() { children_.stop_restarting(); }
  /// Gives the processes two seconds to end by themselves.
  void let_finish() { children_.let_finish(); }
  /// Returns the CPU time of all processes together so far [s].
  double cpu_seconds();

 private:
  tool::Children::Listener listener(std::function<void(const std::string&)> failed);

  std::mutex mutex_;
  std::vector<pid_t> pids_;
  tool::Children children_;
};

}  // namespace cohort::bench
