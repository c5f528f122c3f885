// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tools/exec/clock_page.hpp"
#include "tools/exec/thread_watch.hpp"

namespace cohort::exec {

/// Finds actions of a program in virtual time that happen in real time, and reports each to the user once.
class RealTimeReports {
 public:
  RealTimeReports(ClockPage& page, std::string name) : page_(page), name_(std::move(name)) {}

  /// Returns reports on calls that wait in real time, once for each such function and process. `process` is the
  /// program's main process.
  std::vector<std::string> new_calls(pid_t process);
  /// Collects calls for `new_calls`, because the processes that made them may end.
  void note_calls();
  /// Returns reports on processes whose program does not use the library. A process may have replaced its program by
  /// `exec` since the library was in it.
  std::vector<std::string> new_programs(const std::vector<pid_t>& processes);
  /// Returns reports on threads that sleep by direct system calls.
  std::vector<std::string> new_sleepers(const ThreadWatch& watch);
  /// Forgets a process that has ended.
  void forget(pid_t process) { known_.erase(process); }

 private:
  struct Known {
    std::string image{};
    bool is_real = false;  // as has been reported
    std::uint64_t calls = 0;
  };
  struct Call {
    pid_t process = 0;
    std::size_t number = 0;
  };
  bool has_library(pid_t process) const;
  bool sleeps_by_library(pid_t thread) const;

  ClockPage& page_;
  std::string name_;
  std::map<pid_t, Known> known_{};
  std::set<pid_t> sleepers_{};
  std::vector<Call> calls_{};
  std::uint32_t seen_calls_ = 0;
};

}  // namespace cohort::exec
