// SPDX-License-Identifier: Apache-2.0
#include "server/run/run_world.hpp"

#include <optional>
#include <utility>

#include "server/core/processors.hpp"
#include "server/placement/with_seed.hpp"
#include "server/run/exchange.hpp"

namespace cohort::session {

unsigned threads_for(const description::Experiment& experiment, unsigned wanted) {
  if (wanted == 0) wanted = experiment.threads;
  return wanted == 0 ? available_processors() : wanted;
}

std::shared_ptr<const description::Experiment> with_seed(
    const std::shared_ptr<const description::Experiment>& experiment, std::uint64_t seed) {
  if (seed == experiment->seed) return experiment;
  return std::make_shared<description::Experiment>(placement::with_seed(*experiment, seed));
}

RunWorld build_world(std::shared_ptr<const description::Experiment> experiment, unsigned threads,
                     const SessionSnapshot* from) {
  RunWorld world{std::move(experiment), nullptr};
  world.simulation = std::make_unique<Simulation>(*world.experiment, threads);
  if (from != nullptr) restore(*from, *world.simulation);
  return world;
}

RunWorld build_next_world(const NextRun& next, const RunWorld& now, unsigned threads) {
  RunWorld world = build_world(with_seed(now.experiment, next.seed), threads, next.snapshot.get());
  if (next.snapshot) {
    Exchange tried(*world.simulation);
    restore(*next.snapshot, tried);
  }
  return world;
}

RunResult run_with_resets(RunWorld& world, RunOptions options, unsigned threads,
                          const std::function<RunResult(const RunWorld&, const RunOptions&)>& run_once,
                          const std::function<void(const RunResult&, const RunWorld&)>& on_next) {
  for (;;) {
    std::optional<RunWorld> next;
    options.prepare = [&](const NextRun& wanted) { next = build_next_world(wanted, world, threads); };
    RunResult result = run_once(world, options);
    if (!result.next) return result;
    on_next(result, *next);
    world.simulation.reset();
    world = std::move(*next);
    options.speed = result.next->speed;
    options.state = result.next->state;
    options.from = result.next->snapshot;
    options.rewound = result.next->rewound;
  }
}

}  // namespace cohort::session
