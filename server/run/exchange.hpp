#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/lockstep/barrier.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::session {

/// The meeting of a simulation and its barrier: observations out, commands in, whatever carries them. Not thread-safe.
class Exchange {
 public:
  explicit Exchange(Simulation& simulation);

  lockstep::Barrier& barrier() { return barrier_; }
  const lockstep::Barrier& barrier() const { return barrier_; }

  /// Robots that have come to the simulation since, at this boundary.
  void add_newcomers();

  /// Opens the simulation's current tick and keeps the observations of all robots due.
  void open(lockstep::Time now);

  /// The robots of `robots` that are due at `tick`, and their observations in a row. `tick` is the current one or one
  /// of the delay before it.
  struct Frame {
    std::vector<std::uint32_t> robots{};
    std::span<const double> values{};  ///< good until the next step, or the next `fill_frame` of this frame
    std::vector<double> gathered{};    ///< where they are, unless they lie in a row elsewhere
  };
  void fill_frame(Frame& frame, std::span<const std::uint32_t> robots, std::uint64_t tick) const;

  struct Rejection {
    std::string reason;  ///< a word of docs/protocol.md
    std::string text;
  };
  struct Taken {
    std::size_t accepted = 0;            ///< robots whose answer was taken
    std::optional<Rejection> rejection;  ///< the first thing wrong, if anything is
    bool is_fault = false;               ///< the values cannot act on some robot: a miss at once
    bool ends_run = false;               ///< and that robot's policy has no way to go on
  };
  /// Takes the answer to a frame that was sent to the holder of `held`, at time `now`.
  Taken take(std::span<const std::uint32_t> held, std::uint64_t frame_tick, std::span<const std::uint32_t> robots,
             std::span<const double> values, lockstep::Time now = lockstep::Time{0});

  /// Gives the complete tick's outcomes to the simulation, in the order of the robots. The robots whose commands are
  /// others than before, good until the next call.
  std::span<const std::uint32_t> apply();

  /// At a boundary: the barrier, and the observations of frames whose answers do not act yet.
  void save(SnapshotWriter& writer) const;
  /// Of an exchange of the same experiment, right after the construction of this one, with the simulation restored.
  /// Throws SnapshotError.
  void restore(SnapshotReader& reader);

 private:
  void add_robots(std::uint64_t first_tick);
  std::span<const double> kept(std::uint32_t robot, std::uint64_t tick) const;

  Simulation& simulation_;
  lockstep::Barrier barrier_;
  // By robot: delay + 1 observations, by tick modulo delay + 1. None without a delay: the simulation has the only one.
  std::vector<std::vector<double>> history_;
  std::vector<std::uint32_t> due_;      // reused
  std::vector<std::uint32_t> changed_;  // of the last tick
};

}  // namespace cohort::session
