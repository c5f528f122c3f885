// A stranger that floods a server: flood DOMAIN RATE. Sends RATE commands a second in nobody's name until it is killed.

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "idl/wire.hpp"

int main(int argc, char** argv) {
  using namespace cohort;
  using Clock = std::chrono::steady_clock;
  if (argc != 3) return 2;
  auto participant = wire::Participant::client(static_cast<std::uint32_t>(std::stoul(argv[1])));
  const double rate = std::stod(argv[2]);
  wire::Writer<wire::Command> commands(participant);
  while (commands.matched() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::puts("flooding");
  std::fflush(stdout);
  const std::vector<std::uint32_t> robots = {0};
  const std::vector<double> values(8, 0.1);
  for (;;) {
    // In bursts of a millisecond; what was missed while it was stopped is not made up for.
    const auto begin = Clock::now();
    for (int i = 0; i < static_cast<int>(rate / 1000.0); ++i) commands.write({1, 1, 1, 0, robots, values});
    std::this_thread::sleep_until(begin + std::chrono::milliseconds(1));
  }
}
