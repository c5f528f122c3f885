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

/// By robot, what its controller remembers; nothing where that is not known.
using ControllerStates = std::vector<std::optional<ControllerState>>;

/// A run at a boundary: its world, what its barrier holds, and what its controllers remember. Whoever goes on from it,
/// here or in another process, has the same bits from there on, if all controllers that remember something save it.
struct SessionSnapshot {
  std::string experiment;  ///< its name
  std::uint64_t seed = 0;
  std::uint64_t tick = 0;
  std::vector<std::byte> simulation;  ///< Simulation::save
  std::vector<std::byte> exchange;    ///< Exchange::save
  ControllerStates controllers{};     ///< after their answers to the last frame before `tick`; none if nobody was asked
  BuildIdentity build = this_build();  ///< that took it
};

SessionSnapshot take_snapshot(const description::Experiment& experiment, const Simulation& simulation,
                              const Exchange& exchange, ControllerStates controllers = {});

/// As they are kept in a file: a mark, the format's version, that of Cohort, its commit and arithmetic, the above, and
/// a hash of it all.
std::vector<std::byte> to_bytes(const SessionSnapshot& snapshot);
/// Throws SnapshotError if they are no snapshot, of another version of Cohort, damaged or cut short.
SessionSnapshot snapshot_from_bytes(std::span<const std::byte> bytes);

/// Of `robots`, those that have their state in the snapshot.
std::vector<RobotState> states_of(const SessionSnapshot& snapshot, std::span<const std::uint32_t> robots);

/// A sentence for each team with robots whose state is not in the snapshot. None at the very beginning of a run, where
/// there is nothing to remember.
std::vector<std::string> what_is_left_out(const SessionSnapshot& snapshot, const description::Experiment& experiment);

/// Throws SnapshotError if it is of another experiment. Its seed may be another than this one's.
void expect_same_experiment(const SessionSnapshot& snapshot, const description::Experiment& experiment);

/// Brings a simulation that was built of the same experiment and seed, and not used yet, to where the snapshot is.
/// Throws SnapshotError; the simulation is then not to be used.
void restore(const SessionSnapshot& snapshot, Simulation& simulation);
/// The same for its exchange, afterwards.
void restore(const SessionSnapshot& snapshot, Exchange& exchange);

/// Throws SnapshotError, which names the file.
SessionSnapshot read_snapshot(const std::filesystem::path& file);

}  // namespace cohort::session
