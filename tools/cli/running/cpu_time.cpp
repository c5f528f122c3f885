// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/cpu_time.hpp"

#include <sys/resource.h>
#include <sys/types.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace cohort::tool {
namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double cpu_seconds_of(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return 0.0;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// The kernel adds the time of a child to RUSAGE_CHILDREN only when its end has been waited for.
double cpu_seconds_of_running_children() {
  double total = 0.0;
  std::error_code is_over;
  using Folder = std::filesystem::directory_iterator;
  for (Folder thread("/proc/self/task", is_over); !is_over && thread != Folder(); thread.increment(is_over)) {
    std::ifstream children(thread->path() / "children");
    for (pid_t child = 0; children >> child;) total += cpu_seconds_of(child);
  }
  return total;
}

}  // namespace

double cpu_seconds() {
  double total = cpu_seconds_of_running_children();
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    ::getrusage(who, &usage);
    total += seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  }
  return total;
}

}  // namespace cohort::tool
