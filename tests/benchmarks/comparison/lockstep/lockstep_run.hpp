// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/serving/server.hpp"
#include "tests/benchmarks/comparison/lockstep/bench_processes.hpp"

namespace cohort::bench {

/// The robots of each process: the first one, and one past the last.
using Shares = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// The clients of an idle run.
struct IdleClients {
  Shares shares;
  bool inline_step = true;
  double work = 0.0;  ///< CPU time of each step of a process [s]
};

/// Callbacks of a run, called on its thread. Each may be empty.
struct LockstepListener {
  std::function<void()> boundary{};               ///< before the first frame and after each step
  std::function<void(double seconds)> barrier{};  ///< from a tick's first frame to the last answer needed
};

/// A server of idle robots and its client processes. Except for the world, it is the server of `cohort run`.
class LockstepRun {
 public:
  /// Starts the clients. `delay` is the delay of the controllers in ticks.
  LockstepRun(std::uint32_t robots, std::uint32_t delay, const IdleClients& clients);

  BenchProcesses& clients() { return *clients_; }
  std::uint64_t tick() const { return simulation_.tick(); }
  /// Runs until `stop` is called, or `interrupted` is set. Throws std::runtime_error if anything fails.
  void run(const LockstepListener& listener, const std::atomic<bool>& interrupted);
  /// Stops the run; called by the listener.
  void stop() { stop_ = true; }

 private:
  void open_domains(std::size_t wanted);

  const description::Experiment experiment_;
  Simulation simulation_;
  std::atomic<bool> stop_ = false;
  std::vector<std::uint32_t> domains_;
  std::vector<wire::Participant> participants_;
  std::unique_ptr<session::Server> server_;
  std::unique_ptr<BenchProcesses> clients_;
};

}  // namespace cohort::bench
