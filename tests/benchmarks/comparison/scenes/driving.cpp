// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/scenes/driving.hpp"

#include <string>

namespace cohort::bench {
namespace {

constexpr double max_track_speed = 0.2;   // [m/s]
constexpr double max_turret_rate = 1.0;   // [rad/s]
constexpr std::uint64_t least_ticks = 5;  // minimum number of ticks between two draws
constexpr std::uint64_t most_ticks = 19;

}  // namespace

RandomDriving::RandomDriving(std::uint64_t seed, std::uint32_t robots) : next_draw_(robots, 0) {
  for (std::uint32_t robot = 0; robot < robots; ++robot) random_.emplace_back(seed, std::to_string(robot), "drive");
}

Command RandomDriving::draw(std::uint32_t robot, std::uint64_t tick) {
  const RandomStream& random = random_[robot];
  const auto within = [&](double most, std::uint32_t draw) { return most * (2.0 * random.uniform(tick, draw) - 1.0); };
  next_draw_[robot] = tick + least_ticks + random.bits(tick, 3) % (most_ticks - least_ticks + 1);
  return {within(max_track_speed, 0), within(max_track_speed, 1), within(max_turret_rate, 2)};
}

}  // namespace cohort::bench
