// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "server/core/pose.hpp"
#include "server/core/worker_pool.hpp"
#include "server/description/experiment.hpp"
#include "server/placement/placer.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort {

/// Many worlds of one experiment in one process, for learning. Each is a Simulation, all are stepped by one pool of
/// workers, and the caller is the controller of all robots.
///
/// Values are float64 in SI units, with the channels of `kinds()`. The meaning and the frame of a channel are
/// documented with its device (docs/reference). Arrays are contiguous, in the order of their indices, the last one
/// fastest; their addresses never change. Robots of different models have different channels, so the rows of an array
/// are as long as the longest one. The rest of a shorter row is zero in `observations` and is not read in `commands`.
///
/// A world has the same bits as a single run of the same experiment with the same seed, independent of the other worlds
/// and the number of threads. Events, stop conditions, noise and batteries work as in a run, and observations are taken
/// according to the team's `period` and `phase`. The controllers, `delay` and `on_late` of the teams have no effect, as
/// a command acts from the next tick on.
///
/// For one thread. An error leaves all other worlds in a valid state.
class Batch {
 public:
  /// Bits of an entry of `done`; 0: the world continues.
  enum Done : std::uint8_t {
    stopped = 1,      ///< a stop condition of the experiment is met
    timed_out = 2,    ///< the duration of the experiment is over
    quarantined = 4,  ///< a robot is quarantined: its state is not finite, or it left the world; the others continue
    failed = 8,       ///< `step` threw because of this world
  };

  /// All worlds start with the experiment's seed. `worlds` and `threads` are at least 1. Throws std::invalid_argument
  /// for a world that cannot be simulated, and for an experiment with events that spawn.
  Batch(const description::Experiment& experiment, std::size_t worlds, unsigned threads);
  ~Batch();

  std::size_t worlds() const { return worlds_.size(); }
  /// Returns the number of robots of a world, including those that an event adds later.
  std::uint32_t robots() const { return robots_; }
  const std::string& robot_name(std::uint32_t robot) const { return worlds_[0]->robot_name(robot); }
  std::span<const RobotKind> kinds() const { return worlds_[0]->kinds(); }
  std::uint32_t kind_of(std::uint32_t robot) const { return worlds_[0]->kind_of(robot); }
  std::size_t observation_size() const { return observation_size_; }  ///< length of the longest row
  std::size_t command_size() const { return command_size_; }          ///< length of the longest row

  /// [world, robot, channel]. Observations of the last tick at which the robot was due. Zero before, and for a robot
  /// that has never been in the world.
  std::span<const double> observations() const { return observations_; }
  /// [world, robot, channel], to be written between calls. The values act at each tick of `step`; a reset sets neutral
  /// values.
  std::span<double> commands() { return commands_; }
  /// [world, robot, 7]: x y z [m] and qw qx qy qz of the root link in the world frame.
  std::span<const double> poses() const { return poses_; }
  /// [world]: `Done` bits. A world with `stopped`, `timed_out` or `failed` is not stepped until it is reset.
  std::span<const std::uint8_t> done() const { return done_; }

  /// Steps all worlds that are not done by `ticks` ticks, which is at least 1. `only`, if not empty, has a value for
  /// each world; worlds with 0 are not stepped. Throws std::invalid_argument before any world has moved if a command is
  /// invalid, naming world, robot and channel. Throws std::runtime_error after all worlds have moved if an event cannot
  /// be carried out, or if the state of a body in a `strict` world is no longer finite. The message names the first
  /// such world, and each of them is marked `failed`. Ends early if `stop`, which may be null, becomes true.
  void step(std::uint64_t ticks = 1, std::span<const std::uint8_t> only = {}, const std::atomic<bool>* stop = nullptr);

  /// Restarts a world with `seed`, as if the experiment had been read with it. Reads no file. Throws
  /// std::invalid_argument, and changes nothing, if there is no such world or the experiment cannot have this seed.
  void reset(std::size_t world, std::uint64_t seed);
  /// Does the same, but places each object of the experiment at `X_WM[object]` instead of the pose from the seed.
  void reset(std::size_t world, std::uint64_t seed, std::span<const Pose> X_WM);

  std::uint64_t tick(std::size_t world) const { return worlds_[world]->tick(); }
  /// Returns the state hash, which equals that of a single run at this tick.
  std::uint64_t hash(std::size_t world) const { return worlds_[world]->state_hash(); }
  const Simulation& simulation(std::size_t world) const { return *worlds_[world]; }

 private:
  std::vector<Pose> placed(std::uint64_t seed) const;
  void expect_world(std::size_t world) const;
  void take(std::size_t world);
  void fill_neutral(std::size_t world);
  void check_commands(std::size_t world) const;
  void run(std::size_t world, std::uint64_t ticks, const std::atomic<bool>* stop);
  bool stands_still(std::size_t world) const { return (done_[world] & (stopped | timed_out | failed)) != 0; }
  std::span<const double> command(std::size_t world, std::uint32_t robot) const;

  Simulation first_;  // never stepped; all worlds are built like it
  placement::Placer placer_;
  std::vector<Pose> described_poses_;  // X_WM of each object with the experiment's own seed
  std::uint64_t last_tick_;
  WorkerPool workers_;
  std::vector<std::unique_ptr<Simulation>> worlds_;
  bool is_on_its_way_back_ = false;  // the step visits the worlds from the last to the first
  std::uint32_t robots_ = 0;
  std::size_t observation_size_ = 0;
  std::size_t command_size_ = 0;
  std::vector<double> observations_;
  std::vector<double> commands_;
  std::vector<double> poses_;
  std::vector<std::uint8_t> done_;
  std::vector<std::string> failures_;  // failure of the current step, by world; empty: none
};

}  // namespace cohort
