// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/description/experiment.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::python {

/// Replaces each value that exceeds a bound of its channel only by float32 rounding, such as from a policy, by the
/// bound.
void take_bounds_of_float32(const std::vector<Channel>& channels, std::span<double> values);

/// A Simulation with the observations and commands of its robots in arrays [robot, channel]. Rows are as long as the
/// longest one. Not thread-safe.
class ArraySimulation {
 public:
  ArraySimulation(std::shared_ptr<const description::Experiment> experiment, unsigned threads);

  Simulation& simulation() { return *simulation_; }
  const Simulation& simulation() const { return *simulation_; }
  const description::Experiment& experiment() const { return *experiment_; }
  unsigned threads() const { return threads_; }

  std::size_t observation_size() const { return observation_size_; }
  std::size_t command_size() const { return command_size_; }
  /// Returns an array [robot, channel]. A new array replaces it after robots were added, and after a reset or a
  /// restore.
  const std::shared_ptr<std::vector<double>>& observations() const { return observations_; }
  const std::shared_ptr<std::vector<double>>& commands() const { return commands_; }

  /// Returns the number of the world, which changes at each reset or restore.
  std::uint32_t world_number() const { return world_number_; }

  bool is_timed_out() const;
  bool is_over() const { return simulation_->stop_reason().has_value() || is_timed_out(); }

  /// Passes the commands to the simulation. Throws std::invalid_argument, and changes nothing, if one is invalid.
  void command();
  /// Steps one tick with the commands that were passed.
  void step();
  /// Performs an action between steps.
  std::string act(const Action& action);
  void reset(std::shared_ptr<const description::Experiment> experiment);
  /// Restores a snapshot. Throws SnapshotError, and changes nothing, if it does not match.
  void restore(std::span<const std::byte> snapshot);

 private:
  void make_arrays();
  void take_observations();

  std::shared_ptr<const description::Experiment> experiment_;
  unsigned threads_;
  std::unique_ptr<Simulation> simulation_;
  std::uint32_t world_number_ = 0;
  std::size_t observation_size_ = 0;
  std::size_t command_size_ = 0;
  std::shared_ptr<std::vector<double>> observations_;
  std::shared_ptr<std::vector<double>> commands_;
};

}  // namespace cohort::python
