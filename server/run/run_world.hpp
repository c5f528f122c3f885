// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "server/description/experiment.hpp"
#include "server/run/run.hpp"
#include "server/run/session_snapshot.hpp"
#include "server/simulation/simulation.hpp"

/// The worlds of a run: the initial one, and those of resets and snapshots.
namespace cohort::session {

/// A world that has not been stepped yet, at tick 0 or at the tick of a snapshot.
struct RunWorld {
  std::shared_ptr<const description::Experiment> experiment{};
  std::unique_ptr<Simulation> simulation{};
};

/// Returns the number of threads that step an experiment's world: `wanted`, or if that is 0 the experiment's setting.
/// If that is 0 too, one for each processor that this process may use.
unsigned threads_for(const description::Experiment& experiment, unsigned wanted);

/// Returns the experiment with this seed, with random placements of this seed. Throws description::InputError if there
/// is not enough room.
std::shared_ptr<const description::Experiment> with_seed(
    const std::shared_ptr<const description::Experiment>& experiment, std::uint64_t seed);

/// Builds the experiment's world, and restores it if there is a snapshot `from`. Throws description::InputError and
/// SnapshotError.
RunWorld build_world(std::shared_ptr<const description::Experiment> experiment, unsigned threads,
                     const SessionSnapshot* from);

/// Builds the world of `next`, which replaces `now`. Throws if any part is invalid, including its barrier.
RunWorld build_next_world(const NextRun& next, const RunWorld& now, unsigned threads);

/// Runs a world, and then each world that replaces it after a reset or a snapshot, until a run ends otherwise. Returns
/// the result of the last run; `world` is the last world.
///
/// `run_once` runs one world with these options: `run_in_process` or `Server::run`. `on_next` is called with the result
/// of a replaced run and with the new world, while both worlds exist. Everything runs on the calling thread.
RunResult run_with_resets(RunWorld& world, RunOptions options, unsigned threads,
                          const std::function<RunResult(const RunWorld&, const RunOptions&)>& run_once,
                          const std::function<void(const RunResult&, const RunWorld&)>& on_next);

}  // namespace cohort::session
