// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/lockstep/look_ahead.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tests/benchmarks/comparison/lockstep/bench_client.hpp"
#include "tests/benchmarks/comparison/lockstep/lockstep_run.hpp"
#include "tests/benchmarks/comparison/measuring/clocks.hpp"

namespace cohort::bench {
namespace {

constexpr std::uint32_t robots = 8;
constexpr std::uint64_t first_ticks = 20;  // not counted
constexpr double works[] = {1e-3, 5e-3, 10e-3};

// Returns the median wall time of a tick.
double run_once(std::uint32_t delay, double work, const LockstepOptions& options, const Surroundings& surroundings) {
  LockstepRun run(robots, delay, {{{0, robots}}, options.inline_step, work});
  std::vector<double> ticks;
  double begin = 0.0;
  double last = 0.0;
  LockstepListener listener;
  listener.boundary = [&] {
    if (run.tick() > 0) compute(work);  // simulates the duration of a step
    const double now = wall_seconds();
    if (run.tick() == first_ticks) begin = now;
    if (run.tick() > first_ticks) ticks.push_back(now - last);
    last = now;
    if (run.tick() > first_ticks && now - begin >= options.seconds) run.stop();
  };
  run.run(listener, surroundings.stop);
  if (surroundings.stop) throw Interrupted();
  return spread_of(std::move(ticks)).median;
}

}  // namespace

std::vector<LookAheadRow> measure_look_ahead(const LockstepOptions& options, const Surroundings& surroundings) {
  std::vector<LookAheadRow> rows;
  for (const double work : works) {
    std::vector<LookAheadRow> both = {{0, work, {}}, {1, work, {}}};
    for (unsigned repetition = 1; repetition <= options.repetitions; ++repetition)
      for (LookAheadRow& row : both) {
        surroundings.progress(fmt::format("look-ahead, {:g} ms, delay {}: repetition {} of {}", 1e3 * work, row.delay,
                                          repetition, options.repetitions));
        row.median.push_back(run_once(row.delay, work, options, surroundings));
      }
    rows.insert(rows.end(), both.begin(), both.end());
  }
  return rows;
}

}  // namespace cohort::bench
