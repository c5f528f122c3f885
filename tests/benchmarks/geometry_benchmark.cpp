// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <numeric>

#include "server/geometry/scene/scene.hpp"
#include "tests/benchmarks/comparison/scenes/bench_scene.hpp"
#include "tests/benchmarks/comparison/scenes/ray_field.hpp"

namespace cohort::bench {
namespace {

constexpr std::uint64_t seed = 1;
constexpr std::uint32_t robots = 1000;

double spacing_of(const benchmark::State& state) { return 0.01 * static_cast<double>(state.range(0)); }

// Casts 24 rays from each robot. The argument is the spacing of robots in centimetres.
void cast_rays(benchmark::State& state) {
  const RayField field(robots, spacing_of(state), seed);
  for ([[maybe_unused]] auto iteration : state) benchmark::DoNotOptimize(field.cast());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(field.rays()));
}
BENCHMARK(cast_rays)->Arg(70)->Arg(14)->Unit(benchmark::kMicrosecond);

// Sets all poses and updates the grid.
void move_all(benchmark::State& state) {
  RayField field(robots, spacing_of(state), seed);
  for ([[maybe_unused]] auto iteration : state) field.move_all();
  state.SetItemsProcessed(state.iterations() * robots);
}
BENCHMARK(move_all)->Arg(70)->Arg(14)->Unit(benchmark::kMicrosecond);

void build_grid(benchmark::State& state) {
  const Scene scene = crowd(static_cast<std::uint32_t>(state.range(0)), seed);
  const double radius = scene.robot.turret.radius;
  std::vector<geometry::Bounds> bounds;
  for (const Placement& at : scene.robots)
    bounds.push_back({{at.x - radius, at.y - radius, 0.0}, {at.x + radius, at.y + radius, 0.1}});
  std::vector<std::uint32_t> items(bounds.size());
  std::iota(items.begin(), items.end(), 0u);
  geometry::Grid grid;
  grid.set_cell_size(4.0 * radius);
  for ([[maybe_unused]] auto iteration : state) grid.build(items, bounds);
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(build_grid)->Arg(100)->Arg(10000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace cohort::bench
