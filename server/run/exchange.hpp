// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/lockstep/barrier.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::session {

/// Connects a simulation with its barrier: passes observations out and commands in, for any transport. Not thread-safe.
class Exchange {
 public:
  explicit Exchange(Simulation& simulation);

  lockstep::Barrier& barrier() { return barrier_; }
  const lockstep::Barrier& barrier() const { return barrier_; }

  /// Adds the robots that have joined the simulation since the last call, at this boundary.
  void add_newcomers();

  /// Opens the simulation's current tick and keeps the observations of all due robots.
  void open(lockstep::Time now);

  /// The due robots among `robots` at `tick`, with their concatenated observations. `tick` is the current one or one
  /// within the delay before it.
  struct Frame {
    std::vector<std::uint32_t> robots{};
    std::span<const double> values{};  ///< valid until the next step, or the next `fill_frame` of this frame
    std::vector<double> gathered{};    ///< storage of the values, unless they are contiguous elsewhere
  };
  void fill_frame(Frame& frame, std::span<const std::uint32_t> robots, std::uint64_t tick) const;

  struct Rejection {
    std::string reason;  ///< a keyword of docs/protocol.md
    std::string text;
  };
  struct Taken {
    std::size_t accepted = 0;            ///< number of robots whose answer was taken
    std::optional<Rejection> rejection;  ///< the first fault, if there is any
    bool is_fault = false;               ///< the values are invalid for some robot, which counts as a miss at once
    bool ends_run = false;               ///< and that robot's policy ends the run
  };
  /// Takes the answer to a frame that was sent to the holder of the robots `held`, at time `now`.
  Taken take(std::span<const std::uint32_t> held, std::uint64_t frame_tick, std::span<const std::uint32_t> robots,
             std::span<const double> values, lockstep::Time now = lockstep::Time{0});

  /// Passes the outcomes of the complete tick to the simulation, in the order of the robots. Returns the robots whose
  /// commands have changed, valid until the next call.
  std::span<const std::uint32_t> apply();

  /// Saves, at a boundary, the barrier and the observations of frames whose answers have no effect yet.
  void save(SnapshotWriter& writer) const;
  /// Restores the state of an exchange of the same experiment. Call this right after the construction, when the
  /// simulation has been restored. Throws SnapshotError.
  void restore(SnapshotReader& reader);

 private:
  void add_robots(std::uint64_t first_tick);
  std::span<const double> kept(std::uint32_t robot, std::uint64_t tick) const;
  bool are_of_frame(std::span<const std::uint32_t> robots, std::span<const std::uint32_t> held,
                    std::uint64_t frame_tick) const;

  Simulation& simulation_;
  lockstep::Barrier barrier_;
  // By robot: delay + 1 observations, by tick modulo delay + 1. Empty without a delay, because the simulation itself
  // has the latest observation.
  std::vector<std::vector<double>> history_;
  std::vector<std::uint32_t> changed_;  // robots of the last tick
};

}  // namespace cohort::session
