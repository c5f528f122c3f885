// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/scenes/bench_scene.hpp"

#include <cmath>
#include <numbers>

#include "server/core/random.hpp"

namespace cohort::bench {
namespace {

constexpr double covered = 0.17;     // covered fraction of the arena's floor
constexpr double spread_cell = 2.0;  // two robots at 0.2 m/s meet after 4.7 s at the earliest

}  // namespace

CylinderBody Robot::chassis_without_wheels() const {
  CylinderBody rest = chassis;
  rest.mass -= 2.0 * wheel_mass;
  rest.z = (chassis.mass * chassis.z - 2.0 * wheel_mass * wheel_radius) / rest.mass;
  return rest;
}

std::vector<Wall> Scene::walls() const {
  std::vector<Wall> walls;
  if (!half_arena) return walls;
  const double way = *half_arena + 0.5 * wall_thickness;
  const double length = 2.0 * (*half_arena + wall_thickness);
  for (const double sign : {-1.0, 1.0}) {
    walls.push_back({{sign * way, 0.0, 0.5 * wall_height}, {wall_thickness, length, wall_height}});
    walls.push_back({{0.0, sign * way, 0.5 * wall_height}, {length, wall_thickness, wall_height}});
  }
  return walls;
}

std::vector<Placement> in_cells(std::uint32_t robots, double cell, double freedom, std::uint64_t seed) {
  const RandomStream random(seed, "bench", "placement");
  const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(robots)));
  const double first = -0.5 * cell * (columns - 1);
  std::vector<Placement> placements;
  for (std::uint32_t i = 0; i < robots; ++i) {
    const std::uint32_t row = i / columns;
    const auto within = [&](std::uint32_t draw) { return freedom * (2.0 * random.uniform(i, draw) - 1.0); };
    placements.push_back({first + cell * (i % columns) + within(0), first + cell * row + within(1),
                          2.0 * std::numbers::pi * random.uniform(i, 2)});
  }
  return placements;
}

Scene crowd(std::uint32_t robots, std::uint64_t seed) {
  Scene scene;
  const double radius = scene.robot.turret.radius;
  const double side = std::sqrt(robots * std::numbers::pi * radius * radius / covered);
  const double cell = side / std::ceil(std::sqrt(robots));
  scene.half_arena = 0.5 * side;
  scene.robots = in_cells(robots, cell, 0.5 * cell - radius - gap, seed);
  return scene;
}

Scene spread(std::uint32_t robots, std::uint64_t seed) {
  Scene scene;
  scene.robots = in_cells(robots, spread_cell, 0.0, seed);
  return scene;
}

Scene chain(std::uint32_t robots) {
  Scene scene;
  scene.connected = true;
  for (std::uint32_t i = 0; i < robots; ++i) scene.robots.push_back({-scene.connection_length * i, 0.0, 0.0});
  return scene;
}

}  // namespace cohort::bench
