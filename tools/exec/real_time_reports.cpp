// SPDX-License-Identifier: Apache-2.0
#include "tools/exec/real_time_reports.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

#include "tools/exec/preload_library.hpp"
#include "tools/exec/program_file.hpp"
#include "tools/exec/waiting_calls.hpp"

namespace cohort::exec {
namespace {

std::filesystem::path folder_of(pid_t process) { return "/proc/" + std::to_string(process); }

}  // namespace

void RealTimeReports::note_calls() {
  const std::uint32_t count = page_.real_calls;
  if (std::exchange(seen_calls_, count) == count) return;
  for (const Process& each : page_.processes) {
    const std::int32_t id = each.id;
    if (id == 0) continue;
    const std::uint64_t made = each.real_calls;
    Known& process = known_[id];
    const std::uint64_t new_ones = made & ~process.calls;
    process.calls |= made;
    for (std::size_t i = 0; !name_of_real_call(i).empty(); ++i)
      if ((new_ones >> i & 1U) != 0) calls_.push_back({id, i});
  }
}

std::vector<std::string> RealTimeReports::new_calls(pid_t process) {
  note_calls();
  std::vector<std::string> texts;
  for (const Call& call : std::exchange(calls_, {}))
    texts.push_back((call.process == process
                         ? "'" + name_ + "'"
                         : "process " + std::to_string(call.process) + ", which '" + name_ + "' has started,") +
                    " calls " + std::string(name_of_real_call(call.number)) +
                    ", which waits in real time: results may differ from run to run");
  return texts;
}

std::vector<std::string> RealTimeReports::new_programs(const std::vector<pid_t>& processes) {
  std::vector<std::string> texts;
  for (const pid_t id : processes) {
    const std::filesystem::path file = folder_of(id) / "exe";
    std::error_code error;
    const std::string image = std::filesystem::read_symlink(file, error).string();
    Known& process = known_[id];
    if (process.image == image && !error) continue;
    process.image = image;
    std::string why = error ? std::string() : why_not_virtual(file);
    if (why.empty() && !has_library(id)) why = "it does not load the library that replaces its clocks";
    if (why.empty() || std::exchange(process.is_real, true)) continue;
    texts.push_back("process " + std::to_string(id) + (error ? "" : " ('" + image + "')") + ", which '" + name_ +
                    "' has started, runs in real time: " + why);
  }
  return texts;
}

// The memory of another user's process cannot be read.
bool RealTimeReports::has_library(pid_t process) const {
  std::ifstream maps(folder_of(process) / "maps");
  const std::string name = preload_library().filename();
  bool can_be_read = false;
  for (std::string line; std::getline(maps, line); can_be_read = true)
    if (line.ends_with(name)) return true;
  return !can_be_read && std::ranges::any_of(page_.processes, [process](const Process& each) {
    return each.id == process && each.has_started != 0;
  });
}

// Threads of DDS do.
bool RealTimeReports::sleeps_by_library(pid_t thread) const {
  return std::ranges::any_of(page_.real_sleepers, [thread](const auto& id) { return id == thread; });
}

std::vector<std::string> RealTimeReports::new_sleepers(const ThreadWatch& watch) {
  std::vector<std::string> texts;
  for (const ThreadWatch::SystemCall& call : watch.system_calls()) {
    if (!is_sleep(call.number) || known_[call.process].is_real || sleeps_by_library(call.thread)) continue;
    if (!sleepers_.insert(call.thread).second) continue;
    texts.push_back("thread " + std::to_string(call.thread) + " of '" + name_ +
                    "' sleeps in real time: it makes system calls without the C library");
  }
  return texts;
}

}  // namespace cohort::exec
