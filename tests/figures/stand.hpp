// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "server/simulation/simulation.hpp"
#include "tests/figures/tracked_robot.hpp"
#include "tools/common/drawing/chart.hpp"

namespace cohort::figures {

inline constexpr double degree = std::numbers::pi / 180.0;
inline constexpr double exact = 1e-9;  ///< tolerance of values with an exact closed form

using description::at;
using description::static_shape;
/// Returns a pose 1 m above the world's origin, pitched forwards by `pitch` [rad].
Pose leaning(double pitch);

/// Returns a tracked_robot without tracks, fixed to the world.
description::Model held_robot();
void hold(description::Model& model);

/// Returns the values of `measure` at each of `places`, with a closed form for comparison.
Series measured_at(const std::vector<double>& places, const std::function<double(double)>& measure,
                   std::function<double(double)> closed_form, double tolerance = exact, std::string name = {});

/// A small world in which devices are measured: a plane, ticks of 10 ms, one thread. All objects must be added before
/// the first tick.
class Stand {
 public:
  Stand();
  /// Adds a model, and returns its index among all objects.
  std::uint32_t add(const description::Model& model, const Pose& X_WM = {});
  void add_emitter(const decltype(description::Emitter::what)& what, const Pose& X_WM);

  void step(int ticks = 1);
  /// Returns an observed value of robot number `robot`, in the order of adding.
  double read(const std::string& channel, std::size_t index = 0, std::uint32_t robot = 0);
  /// Sets the values of a command channel. The other channels keep their values.
  void command(const std::string& channel, const std::vector<double>& values, std::uint32_t robot = 0);
  double time();  ///< simulated [s]
  Simulation& simulation();

 private:
  static std::size_t offset_of(const std::vector<Channel>& channels, const std::string& name);

  description::Experiment experiment_;
  std::optional<Simulation> simulation_;
  std::vector<std::vector<double>> commands_;
};

}  // namespace cohort::figures
