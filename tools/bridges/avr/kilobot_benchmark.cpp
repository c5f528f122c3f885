// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>
#include <vector>

#include "idl/text/printable.hpp"
#include "tools/bridges/avr/kilobot.hpp"

namespace cohort::avr::kilobot {

void run_benchmark(const Image& image, unsigned robots, bool overhead, double seconds) {
  constexpr double apart = 0.05;                    // [m]
  constexpr std::uint64_t run_message_at = 80'000;  // [cycles]
  constexpr std::uint8_t run_message = 0x88;
  Air air;
  struct Member {
    std::unique_ptr<Core> core;
    std::unique_ptr<Transceiver> transceiver;
  };
  std::vector<Member> members;
  for (unsigned i = 0; i < robots; ++i) {
    Robot::Options options{image, chip()};
    Start start;
    start.robot = i;
    start.seed = i;
    prepare(options, start);
    Member member{std::make_unique<Core>(options.image, options.chip), nullptr};
    member.transceiver = std::make_unique<Transceiver>(air, i, *member.core);
    member.transceiver->hear({{(i + 1) % robots, apart}, {(i + robots - 1) % robots, apart}});
    if (overhead) member.transceiver->receive_message(run_message_at, overhead_message(run_message));
    members.push_back(std::move(member));
  }
  const auto before = std::chrono::steady_clock::now();
  const std::chrono::nanoseconds end{static_cast<std::int64_t>(seconds * 1e9)};
  for (std::chrono::nanoseconds time{0}; time < end; time += air.window()) {
    for (const Member& member : members) member.core->run_until(cycles_in(time, member.core->chip().frequency));
    air.exchange();
  }
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  std::printf(
      "%s on %u Kilobots: simulated %.4g s in %.3g s of wall time on one thread; up to %.3g Kilobots run in real "
      "time\n",
      printable(image.file).c_str(), robots, seconds, took, robots * seconds / took);
  for (const Member& member : members)
    if (member.core->fault())
      std::printf("a microcontroller has crashed: %s\n", printable(*member.core->fault()).c_str());
}

}  // namespace cohort::avr::kilobot
