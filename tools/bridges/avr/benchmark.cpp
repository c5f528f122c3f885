// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/avr/benchmark.hpp"

#include <chrono>
#include <cstdio>

#include "idl/text/printable.hpp"

namespace cohort::avr {

void run_benchmark(const Image& image, const Chip& chip, double seconds) {
  constexpr std::uint64_t frames_in_a_second = 50;
  Core core(image, chip);
  const auto cycles = static_cast<std::uint64_t>(seconds * chip.frequency);
  const auto before = std::chrono::steady_clock::now();
  for (std::uint64_t end = 0; end < cycles;) {
    end += chip.frequency / frames_in_a_second;
    core.run_until(end);
  }
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  std::printf("%s on an %s at %.3g MHz: %.4g s in %.3g s, %.1f simulated MHz, %.3g times real time\n",
              printable(image.file).c_str(), printable(chip.mcu).c_str(), chip.frequency / 1e6, seconds, took,
              static_cast<double>(cycles) / took / 1e6, seconds / took);
  if (core.fault()) std::printf("the microcontroller has crashed: %s\n", printable(*core.fault()).c_str());
}

}  // namespace cohort::avr
