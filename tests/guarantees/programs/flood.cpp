// SPDX-License-Identifier: Apache-2.0

// A stranger that floods one of two servers: flood DOMAIN DOMAIN RATE. Sends RATE commands a second with an invalid
// client id to the first. After SIGUSR1 it sends to the other one, and so on, until it is killed. Prints each turn's
// number once it has sent some. So its own load on the machine stays the same.

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "idl/dds/transport.hpp"

namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a signal handler reaches nothing but globals.
volatile std::sig_atomic_t turns = 0;

struct Target {
  explicit Target(const char* domain)
      : participant(cohort::wire::Participant::client(static_cast<std::uint32_t>(std::stoul(domain)))),
        commands(participant) {
    while (commands.matched() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  cohort::wire::Participant participant;
  cohort::wire::Writer<cohort::wire::Command> commands;
};

}  // namespace

int main(int argc, char** argv) {
  using Clock = std::chrono::steady_clock;
  if (argc != 4) return 2;
  std::signal(SIGUSR1, [](int) { turns = turns + 1; });
  std::array<Target, 2> targets = {Target(argv[1]), Target(argv[2])};
  const double rate = std::stod(argv[3]);
  const std::vector<std::uint32_t> robots = {0};
  const std::vector<double> values(8, 0.1);
  for (int said = -1;;) {
    // Sends bursts of a millisecond; a late burst is not made up for.
    const auto begin = Clock::now();
    const int turn = turns;
    auto& commands = targets.at(static_cast<std::size_t>(turn % 2)).commands;
    for (int i = 0; i < static_cast<int>(rate / 1000.0); ++i) commands.write({1, 1, 1, 0, robots, values});
    if (turn != said) {
      std::printf("turn %d.\n", turn);
      std::fflush(stdout);
      said = turn;
    }
    std::this_thread::sleep_until(begin + std::chrono::milliseconds(1));
  }
}
