// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/simulation/simulation.hpp"
#include "tests/support/robots.hpp"

namespace cohort::test {

/// Returns the reading of an infrared or light sensor for a received light `x`.
inline double sigmoid(double x) { return 2.0 / (1.0 + std::exp(-x)) - 1.0; }

/// A world whose robots are read and commanded by channel names. All objects must be added before the first tick.
class SensingWorld {
 public:
  explicit SensingWorld(unsigned threads = 1) : threads_(threads) {}

  std::uint32_t add(const description::Model& model, const std::string& name, const Pose& X_WM) {
    return place(world(), model, name, X_WM);
  }
  /// Adds a static model with one emitter at the origin of its only link, without collisions.
  std::uint32_t add_emitter(const std::string& name, const decltype(description::Emitter::what)& what,
                            const Pose& X_WM) {
    description::Model model = description::static_model(name);
    model.emitters.push_back({name, 0, {}, true, what});
    return add(model, name, X_WM);
  }

  Simulation& simulation() {
    if (!simulation_) {
      description::Team team{"team", {}, "none", policy};
      for (std::uint32_t robot = 0; robot < world().robots.size(); ++robot) team.robots.push_back(robot);
      experiment.teams = {team};
      experiment.duration = std::chrono::hours(1);
      commands_.clear();
      simulation_.emplace(experiment, threads_);
    }
    return *simulation_;
  }
  /// Begins another run of the same experiment.
  void begin_again(unsigned threads) {
    simulation_.reset();
    threads_ = threads;
  }
  void step(int ticks = 1) {
    for (; ticks > 0; --ticks) simulation().step();
  }

  double read(std::uint32_t robot, const std::string& channel, std::size_t index = 0) {
    const RobotKind& kind = simulation().kinds()[simulation().kind_of(robot)];
    return simulation().observation(robot)[offset_of(kind.observation, channel) + index];
  }
  /// Sets a robot's command channel from the next step on. The other channels keep their values.
  void command(std::uint32_t robot, const std::string& channel, const std::vector<double>& values) {
    const RobotKind& kind = simulation().kinds()[simulation().kind_of(robot)];
    commands_.resize(simulation().robot_count());
    commands_[robot].resize(kind.command_size);
    std::copy(values.begin(), values.end(),
              commands_[robot].begin() + static_cast<std::ptrdiff_t>(offset_of(kind.command, channel)));
    simulation().set_command(robot, commands_[robot]);
  }

  description::World& world() { return experiment.world; }

  description::Experiment experiment = [] {
    description::Experiment empty;
    empty.world = world_with_floor();
    return empty;
  }();
  description::Policy policy;

 private:
  static std::size_t offset_of(const std::vector<Channel>& channels, const std::string& name) {
    std::size_t offset = 0;
    for (const Channel& channel : channels) {
      if (channel.name == name) return offset;
      offset += channel.size;
    }
    throw std::invalid_argument("no channel " + name);
  }

  unsigned threads_;
  std::optional<Simulation> simulation_;
  std::vector<std::vector<double>> commands_;
};

}  // namespace cohort::test
