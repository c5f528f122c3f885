// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/lockstep/bench_client.hpp"

#include <ctime>
#include <exception>
#include <utility>

#include "client_sdk/src/attachment.hpp"

namespace cohort::bench {
namespace {

// A controller that answers with neutral values. The first robot of a process does the computation of all its robots.
class Computer final : public Controller {
 public:
  Computer(double work, std::uint32_t& computing) : work_(work), computing_(computing) {}
  void start(const Start& start) override {
    robot_ = start.robot;
    if (computing_ > robot_) computing_ = robot_;
  }
  void step(const Observation&, Command&) override {
    if (work_ > 0.0 && robot_ == computing_) compute(work_);
  }

 private:
  double work_;
  std::uint32_t& computing_;
  std::uint32_t robot_ = 0;
};

}  // namespace

void compute(double seconds) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  for (const double begin = now(); now() - begin < seconds;) continue;
}

int run_bench_client(const BenchClient& client, const std::atomic<bool>& stop) {
  if (client.robots.empty()) {
    run_udp_client(client.udp, stop);
    return 0;
  }
  std::uint32_t computing = ~0u;
  const ControllerKind kind{"bench", [&] {
                              return OwnedController(new Computer(client.work, computing),
                                                     [](Controller* controller) { delete controller; });
                            }};
  ClientOptions options;
  options.domain = client.domain;
  options.robots = client.robots;
  options.inline_step = client.inline_step;
  return run_client(kind, options, stop) == ClientEnd::finished ? 0 : 1;
}

}  // namespace cohort::bench
