#pragma once

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

/// Many worlds of one experiment in one process, for learning: each is a Simulation, all are stepped by one pool of
/// workers, and whoever calls is the controller of all robots.
///
/// Values are float64 in SI units, with the channels of `kinds()`: what a channel measures or moves, and in which
/// frame, is said where its device is (docs/worlds.md). Arrays are contiguous, in the order of their indices, the last
/// one fastest; each has one address for as long as the batch lives. Robots of different models have different
/// channels: the rows of an array are as long as the longest one, and what is behind a robot's own channels is zero in
/// `observations` and is not read in `commands`.
///
/// A world has the same bits as the same experiment read with the same seed and run alone, whatever the other worlds do
/// and for any number of threads. Events, stop conditions, noise and batteries work as in one run, and observations are
/// taken at the ticks that the team's `period` and `phase` say; controllers, `delay` and `on_late` of the teams have no
/// meaning, as a command acts from the next tick on.
///
/// One thread calls all of this. An error leaves every other world as it should be.
class Batch {
 public:
  /// What an entry of `done` is made of; 0: the world goes on.
  enum Done : std::uint8_t {
    stopped = 1,      ///< a stop condition of the experiment holds
    timed_out = 2,    ///< the duration of the experiment is over
    quarantined = 4,  ///< a robot is: its state broke, or it has left the world. The others go on.
    failed = 8,       ///< `step` threw because of this world
  };

  /// All worlds begin with the experiment's seed. `worlds` and `threads` are at least 1. Throws std::invalid_argument
  /// for a world that cannot be simulated, and for an experiment with events that spawn.
  Batch(const description::Experiment& experiment, std::size_t worlds, unsigned threads);
  ~Batch();

  std::size_t worlds() const { return worlds_.size(); }
  /// Robots of a world, also those that an event brings later.
  std::uint32_t robots() const { return robots_; }
  const std::string& robot_name(std::uint32_t robot) const { return worlds_[0]->robot_name(robot); }
  std::span<const RobotKind> kinds() const { return worlds_[0]->kinds(); }
  std::uint32_t kind_of(std::uint32_t robot) const { return worlds_[0]->kind_of(robot); }
  std::size_t observation_size() const { return observation_size_; }  ///< of the longest row
  std::size_t command_size() const { return command_size_; }          ///< of the longest row

  /// [world, robot, channel]. As of the last tick at which the robot was asked; zero before, and while it has never
  /// been in the world.
  std::span<const double> observations() const { return observations_; }
  /// [world, robot, channel], to be written between calls. What stands here acts at each tick that `step` makes; a
  /// reset puts neutral values there.
  std::span<double> commands() { return commands_; }
  /// [world, robot, 7]: x y z [m] and qw qx qy qz of the root link in the world's frame.
  std::span<const double> poses() const { return poses_; }
  /// [world]: `Done` bits. A world with `stopped`, `timed_out` or `failed` stands still until it is reset.
  std::span<const std::uint8_t> done() const { return done_; }

  /// Steps all worlds `ticks` ticks, each world until it stands still; `ticks` is at least 1. `only`, if it is not
  /// empty, has a value for each world, and those with 0 stay as they are. Throws std::invalid_argument before any
  /// world has moved if a command cannot act, naming world, robot and channel. Throws std::runtime_error after all
  /// worlds have moved if an event cannot be done, or a body breaks in a `strict` world: it names the first such world,
  /// and each of them has `failed`.
  void step(std::uint64_t ticks = 1, std::span<const std::uint8_t> only = {});

  /// Begins a world anew with `seed`, as if the experiment had been read with it. Reads no file. Throws
  /// std::invalid_argument, and changes nothing, if there is no such world or the experiment cannot have this seed.
  void reset(std::size_t world, std::uint64_t seed);
  /// The same with each object of the experiment at `X_WM[object]`, wherever the seed would have put it.
  void reset(std::size_t world, std::uint64_t seed, std::span<const Pose> X_WM);

  std::uint64_t tick(std::size_t world) const { return worlds_[world]->tick(); }
  /// The state hash of one run at this tick.
  std::uint64_t hash(std::size_t world) const { return worlds_[world]->state_hash(); }
  const Simulation& simulation(std::size_t world) const { return *worlds_[world]; }

 private:
  std::vector<Pose> placed(std::uint64_t seed) const;
  void expect_world(std::size_t world) const;
  void take(std::size_t world);
  void fill_neutral(std::size_t world);
  void check_commands(std::size_t world) const;
  void run(std::size_t world, std::uint64_t ticks);
  bool stands_still(std::size_t world) const { return (done_[world] & (stopped | timed_out | failed)) != 0; }
  std::span<const double> command(std::size_t world, std::uint32_t robot) const;

  Simulation first_;  // is never stepped; all worlds are built like it
  placement::Placer placer_;
  std::vector<Pose> described_poses_;  // X_WM of each object by the experiment's own seed
  std::uint64_t last_tick_;
  WorkerPool workers_;
  std::vector<std::unique_ptr<Simulation>> worlds_;
  bool is_on_its_way_back_ = false;  // through the worlds, from the last one
  std::uint32_t robots_ = 0;
  std::size_t observation_size_ = 0;
  std::size_t command_size_ = 0;
  std::vector<double> observations_;
  std::vector<double> commands_;
  std::vector<double> poses_;
  std::vector<std::uint8_t> done_;
  std::vector<std::string> failures_;  // of the step under way, by world; empty: none
};

}  // namespace cohort
