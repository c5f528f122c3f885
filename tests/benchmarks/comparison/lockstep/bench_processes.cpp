// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/lockstep/bench_processes.hpp"

#include <ctime>
#include <filesystem>
#include <utility>

namespace cohort::bench {
namespace {

std::vector<tool::Children::Command> commands_of(const std::vector<std::vector<std::string>>& arguments) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe");
  std::vector<tool::Children::Command> commands;
  for (const std::vector<std::string>& own : arguments) {
    tool::Children::Command command;
    command.arguments = {program, "client"};
    command.arguments.insert(command.arguments.end(), own.begin(), own.end());
    command.name = "bench";
    command.restarts = false;
    commands.push_back(std::move(command));
  }
  return commands;
}

}  // namespace

BenchProcesses::BenchProcesses(const std::vector<std::vector<std::string>>& arguments,
                               std::function<void(const std::string&)> failed)
    : children_(commands_of(arguments), listener(std::move(failed))) {}

tool::Children::Listener BenchProcesses::listener(std::function<void(const std::string&)> failed) {
  tool::Children::Listener listener;
  listener.started = [this](const tool::Children::Command&, pid_t pid) {
    const std::lock_guard lock(mutex_);
    pids_.push_back(pid);
  };
  listener.gave_up = std::move(failed);
  return listener;
}

double BenchProcesses::cpu_seconds() {
  const std::lock_guard lock(mutex_);
  double seconds = 0.0;
  for (const pid_t pid : pids_) {
    clockid_t clock{};
    timespec time{};
    if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &time) != 0) continue;
    seconds += static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  return seconds;
}

}  // namespace cohort::bench
