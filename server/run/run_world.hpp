#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "server/description/experiment.hpp"
#include "server/run/run.hpp"
#include "server/run/session_snapshot.hpp"
#include "server/simulation/simulation.hpp"

/// The worlds of a run: the one that it starts in, and those that resets and snapshots put in its place.
namespace cohort::session {

/// A world that nobody has stepped yet, at tick 0 or where a snapshot was taken.
struct RunWorld {
  std::shared_ptr<const description::Experiment> experiment{};
  std::unique_ptr<Simulation> simulation{};
};

/// Returns the threads that step an experiment's world: `wanted`, or if that is 0 what the experiment asks for, or if
/// that is 0 too one for each processor that this process may use.
unsigned threads_for(const description::Experiment& experiment, unsigned wanted);

/// Returns the experiment with this seed, with all that is placed at random where this seed places it. Throws
/// description::InputError if there is no room for it.
std::shared_ptr<const description::Experiment> with_seed(
    const std::shared_ptr<const description::Experiment>& experiment, std::uint64_t seed);

/// Builds the experiment's world, and restores it if there is a snapshot to go on `from`. Throws
/// description::InputError and SnapshotError.
RunWorld build_world(std::shared_ptr<const description::Experiment> experiment, unsigned threads,
                     const SessionSnapshot* from);

/// Builds the world of `next`, which takes the place of `now`. Throws if anything about it is wrong, its barrier
/// included.
RunWorld build_next_world(const NextRun& next, const RunWorld& now, unsigned threads);

/// Runs a world, and then each world that a reset or a snapshot puts in its place, until a run ends otherwise. Returns
/// the result of the last run; `world` is the last world.
///
/// `run_once` runs one world with these options: `run_in_process` or `Server::run`. `on_next` is called with the result
/// of a run that was replaced and with the world that takes its place, while both worlds are there. All on the calling
/// thread.
RunResult run_with_resets(RunWorld& world, RunOptions options, unsigned threads,
                          const std::function<RunResult(const RunWorld&, const RunOptions&)>& run_once,
                          const std::function<void(const RunResult&, const RunWorld&)>& on_next);

}  // namespace cohort::session
