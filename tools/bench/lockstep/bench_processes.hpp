#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "tools/processes/children.hpp"

namespace cohort::bench {

/// Some client processes of `cohort bench lockstep`, and what CPU time they take. Gone when this is.
class BenchProcesses {
 public:
  /// `arguments` of each process, after `cohort bench client`; `failed` is told if one ends before `may_end`.
  BenchProcesses(const std::vector<std::vector<std::string>>& arguments,
                 std::function<void(const std::string&)> failed);

  /// From now on they may end by themselves.
  void may_end() { children_.stop_restarting(); }
  /// Gives them two seconds to.
  void let_finish() { children_.let_finish(); }
  /// Of all together, so far [s].
  double cpu_seconds();

 private:
  tool::Children::Listener listener(std::function<void(const std::string&)> failed);

  std::mutex mutex_;
  std::vector<pid_t> pids_;
  tool::Children children_;
};

}  // namespace cohort::bench
