// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <set>
#include <vector>

#include "server/placement/place.hpp"
#include "server/placement/with_seed.hpp"
#include "tests/support/worlds/arena_of_obstacles.hpp"

// Places a robot in an arena with 24 obstacles, whose poses are fixed (argument 0) or drawn (argument 1).
namespace cohort::placement {
namespace {

World arena(const benchmark::State& state) {
  World world = test::arena_of_obstacles(state.range(0) == 0 ? test::Obstacles::fixed : test::Obstacles::drawn);
  std::set<std::string> names;
  std::vector<Problem> problems;
  add_populations(world, 1, names, problems);
  set_robots(world);
  return world;
}

void prepare(benchmark::State& state) {
  const World world = arena(state);
  for ([[maybe_unused]] auto iteration : state) benchmark::DoNotOptimize(Placer(world));
}
BENCHMARK(prepare)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void place_poses(benchmark::State& state) {
  const World world = arena(state);
  const Placer placer(world);
  std::vector<Pose> poses(placer.count());
  std::uint64_t seed = 0;
  for ([[maybe_unused]] auto iteration : state) benchmark::DoNotOptimize(placer.place(seed++, poses));
}
BENCHMARK(place_poses)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void place_experiment(benchmark::State& state) {
  Experiment experiment;
  experiment.world = arena(state);
  const Placer placer(experiment.world);
  std::uint64_t seed = 0;
  for ([[maybe_unused]] auto iteration : state) benchmark::DoNotOptimize(with_seed(experiment, placer, seed++));
}
BENCHMARK(place_experiment)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace cohort::placement
