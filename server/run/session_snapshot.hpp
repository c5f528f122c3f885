// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/hosting/controller_state.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/experiment.hpp"
#include "server/simulation/build_identity.hpp"

namespace cohort {
class Simulation;
}

namespace cohort::session {

class Exchange;

/// The state of controllers by robot; empty where it is unknown.
using ControllerStates = std::vector<std::optional<ControllerState>>;

/// A run at a boundary: its world, its barrier, and the state of its controllers. A run that continues from it, in any
/// process, has the same bits from there on, if all controllers with state save it.
struct SessionSnapshot {
  std::string experiment;  ///< its name
  std::uint64_t seed = 0;
  std::uint64_t tick = 0;
  std::vector<std::byte> simulation;   ///< bytes of Simulation::save
  std::vector<std::byte> exchange;     ///< bytes of Exchange::save
  ControllerStates controllers{};      ///< after their last answers; empty before the first frame
  BuildIdentity build = this_build();  ///< the build that took it
};

SessionSnapshot take_snapshot(const description::Experiment& experiment, const Simulation& simulation,
                              const Exchange& exchange, ControllerStates controllers = {});

/// Returns the bytes for a file: a magic number, the versions of the format and of Cohort, its commit and arithmetic,
/// the members above, and a hash of it all.
std::vector<std::byte> to_bytes(const SessionSnapshot& snapshot);
/// Parses a snapshot. Throws SnapshotError if the bytes are not a snapshot, are damaged or incomplete, or are from a
/// version of Cohort that `versions_of_snapshots` does not list.
SessionSnapshot snapshot_from_bytes(std::span<const std::byte> bytes);

/// Returns the states in the snapshot of all `robots` whose state is known.
std::vector<RobotState> states_of(const SessionSnapshot& snapshot, std::span<const std::uint32_t> robots);

/// Returns a sentence for each team with robots whose state is not in the snapshot. Returns none at the very beginning
/// of a run, when controllers have no state.
std::vector<std::string> what_is_left_out(const SessionSnapshot& snapshot, const description::Experiment& experiment);

/// Throws SnapshotError if the snapshot is from another experiment. The seed may differ.
void expect_same_experiment(const SessionSnapshot& snapshot, const description::Experiment& experiment);

/// Restores a simulation that was built from the same experiment and seed and has not been used. After a SnapshotError
/// the simulation must not be used.
void restore(const SessionSnapshot& snapshot, Simulation& simulation);
/// Restores the exchange of a simulation that has been restored.
void restore(const SessionSnapshot& snapshot, Exchange& exchange);

/// Reads a snapshot from a file. Throws SnapshotError, which names the file.
SessionSnapshot read_snapshot(const std::filesystem::path& file);

}  // namespace cohort::session
