// SPDX-License-Identifier: Apache-2.0
#include "tools/python/native/array_simulation.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace cohort::python {

void take_bounds_of_float32(const std::vector<Channel>& channels, std::span<double> values) {
  std::size_t at = 0;
  for (const Channel& channel : channels) {
    for (std::uint32_t i = 0; i < channel.size; ++i, ++at) {
      double& value = values[at];
      if (value > channel.upper && value == static_cast<double>(static_cast<float>(channel.upper)))
        value = channel.upper;
      if (value < channel.lower && value == static_cast<double>(static_cast<float>(channel.lower)))
        value = channel.lower;
    }
  }
}

ArraySimulation::ArraySimulation(std::shared_ptr<const description::Experiment> experiment, unsigned threads)
    : experiment_(std::move(experiment)),
      threads_(threads),
      simulation_(std::make_unique<Simulation>(*experiment_, threads)) {
  make_arrays();
}

void ArraySimulation::make_arrays() {
  observation_size_ = command_size_ = 0;
  for (const RobotKind& kind : simulation_->kinds()) {
    observation_size_ = std::max(observation_size_, kind.observation_size);
    command_size_ = std::max(command_size_, kind.command_size);
  }
  const std::size_t robots = simulation_->robot_count();
  observations_ = std::make_shared<std::vector<double>>(robots * observation_size_);
  commands_ = std::make_shared<std::vector<double>>(robots * command_size_);
  for (std::uint32_t robot = 0; robot < robots; ++robot)
    std::ranges::copy(simulation_->command(robot),
                      commands_->begin() + static_cast<std::ptrdiff_t>(robot * command_size_));
  take_observations();
}

void ArraySimulation::take_observations() {
  for (std::uint32_t robot = 0; robot < simulation_->robot_count(); ++robot)
    std::ranges::copy(simulation_->observation(robot), observations_->data() + robot * observation_size_);
}

bool ArraySimulation::is_timed_out() const {
  return experiment_->duration.count() > 0 && simulation_->time() >= experiment_->duration;
}

void ArraySimulation::command() {
  const auto values_of = [&](std::uint32_t robot) {
    const RobotKind& kind = simulation_->kinds()[simulation_->kind_of(robot)];
    const std::span<double> values(commands_->data() + robot * command_size_, kind.command_size);
    take_bounds_of_float32(kind.command, values);
    return values;
  };
  // Released robots have no command either.
  const auto has_none = [&](std::uint32_t robot) { return simulation_->command(robot).empty(); };
  for (std::uint32_t robot = 0; robot < simulation_->robot_count(); ++robot) {
    if (has_none(robot)) continue;
    if (const auto fault = simulation_->check_command(robot, values_of(robot)))
      throw std::invalid_argument(fault->text);
  }
  for (std::uint32_t robot = 0; robot < simulation_->robot_count(); ++robot)
    if (!has_none(robot)) simulation_->set_command(robot, values_of(robot));
}

void ArraySimulation::step() {
  const std::uint32_t robots = simulation_->robot_count();
  simulation_->step();
  if (simulation_->robot_count() == robots)
    take_observations();
  else
    make_arrays();
}

std::string ArraySimulation::act(const Action& action) {
  const std::uint32_t robots = simulation_->robot_count();
  std::string text = simulation_->act(action);
  if (simulation_->robot_count() == robots)
    take_observations();
  else
    make_arrays();
  return text;
}

void ArraySimulation::reset(std::shared_ptr<const description::Experiment> experiment) {
  auto simulation = std::make_unique<Simulation>(*experiment, threads_);
  experiment_ = std::move(experiment);
  simulation_ = std::move(simulation);
  ++world_number_;
  make_arrays();
}

void ArraySimulation::restore(std::span<const std::byte> snapshot) {
  auto simulation = std::make_unique<Simulation>(*experiment_, threads_);
  simulation->restore(snapshot);
  simulation_ = std::move(simulation);
  ++world_number_;
  make_arrays();
}

}  // namespace cohort::python
