// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/scenes/sensing_scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "server/core/random.hpp"
#include "tests/benchmarks/comparison/scenes/bench_scene.hpp"

namespace cohort::bench {
namespace {

constexpr std::uint32_t least_arena = 64;  // number of robots in the smallest arena
constexpr std::uint32_t things = 24;       // number of obstacles or sources in it
constexpr double area_a_robot = 0.1;       // [m^2]
constexpr double widest = 0.071;           // half of the diagonal of a box [m]

// Returns random positions, first of the robots, then of the other objects.
std::vector<Placement> places(std::uint32_t robots, std::uint32_t others, double side, std::uint64_t seed) {
  const std::uint32_t room_for = std::max(robots, least_arena) + others;
  const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(room_for)));
  const double cell = side / columns;
  std::vector<Placement> all = in_cells(columns * columns, cell, 0.5 * cell - widest - gap, seed);
  const RandomStream random(seed, "bench", "cells");
  for (std::uint32_t i = 0; i < robots + others; ++i)  // Fisher and Yates
    std::swap(all[i], all[i + random.bits(i, 0) % (all.size() - i)]);
  all.resize(robots + others);
  return all;
}

SensingScene arena(std::uint32_t robots, std::uint64_t seed) {
  SensingScene result;
  result.seed = seed;
  result.scene.half_arena = 0.5 * std::sqrt(area_a_robot * std::max(robots, least_arena));
  return result;
}

}  // namespace

SensingScene among_obstacles(std::uint32_t robots, std::uint64_t seed) {
  SensingScene result = arena(robots, seed);
  const std::uint32_t obstacles = things * std::max(robots, least_arena) / least_arena;
  const std::vector<Placement> all = places(robots, obstacles, 2.0 * *result.scene.half_arena, seed);
  const auto first = all.begin() + robots;
  result.scene.robots.assign(all.begin(), first);
  result.boxes.assign(first, first + obstacles / 2);
  result.pillars.assign(first + obstacles / 2, all.end());
  return result;
}

SensingScene among_sources(std::uint32_t robots, std::uint64_t seed) {
  constexpr double lowest = 0.05;
  constexpr double highest = 0.25;
  SensingScene result = arena(robots, seed);
  const std::vector<Placement> all = places(robots, things, 2.0 * *result.scene.half_arena, seed);
  result.scene.robots.assign(all.begin(), all.begin() + robots);
  const RandomStream random(seed, "bench", "heights");
  for (std::uint32_t i = 0; i < things; ++i) {
    const Placement& at = all[robots + i];
    result.sources.emplace_back(at.x, at.y, lowest + (highest - lowest) * random.uniform(i, 0));
  }
  return result;
}

}  // namespace cohort::bench
