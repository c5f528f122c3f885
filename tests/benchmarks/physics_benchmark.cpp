// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "tests/benchmarks/comparison/engines/engines.hpp"

namespace cohort::bench {
namespace {

constexpr std::uint64_t seed = 1;
constexpr unsigned steps_a_control_tick = 10;

// Measures one step of robots that have driven at random for a second.
void step_driving(benchmark::State& state, Scene scene, Drive drive) {
  scene.drive = drive;
  const auto robots = static_cast<std::uint32_t>(scene.robots.size());
  const std::unique_ptr<Engine> engine = make_cohort_engine(scene, 1);
  RandomDriving driving(seed, robots);
  std::uint64_t step = 0;
  const auto drive_on = [&] {
    if (step % steps_a_control_tick == 0)
      driving.update(step / steps_a_control_tick,
                     [&](std::uint32_t robot, const Command& command) { engine->set_command(robot, command); });
    ++step;
    engine->step();
  };
  for (int i = 0; i < 100; ++i) drive_on();
  for ([[maybe_unused]] auto iteration : state) drive_on();
  state.SetItemsProcessed(state.iterations() * robots);  // robot-steps
}

std::uint32_t robots_of(const benchmark::State& state) { return static_cast<std::uint32_t>(state.range(0)); }

void step_crowd(benchmark::State& state) { step_driving(state, crowd(robots_of(state), seed), Drive::tracks); }
BENCHMARK(step_crowd)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

void step_apart(benchmark::State& state) { step_driving(state, spread(robots_of(state), seed), Drive::tracks); }
BENCHMARK(step_apart)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

void step_crowd_on_wheels(benchmark::State& state) {
  step_driving(state, crowd(robots_of(state), seed), Drive::wheels);
}
BENCHMARK(step_crowd_on_wheels)->Arg(100)->Unit(benchmark::kMicrosecond);

void build_crowd(benchmark::State& state) {
  const Scene scene = crowd(robots_of(state), seed);
  for ([[maybe_unused]] auto iteration : state) make_cohort_engine(scene, 1)->step();
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(build_crowd)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cohort::bench
