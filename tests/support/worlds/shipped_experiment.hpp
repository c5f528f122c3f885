// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client_sdk/hosting/plugin_loader.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/run/in_process.hpp"

namespace cohort::test {

inline const std::filesystem::path shipped_experiments = COHORT_SOURCE_DIR "/worlds/experiments";

/// Returns the experiment, with Cohort's own dynamics if COHORT_TEST_DYNAMICS is `cohort`. All such tests run with
/// either dynamics.
inline description::Experiment with_dynamics_of_test(description::Experiment experiment) {
  const char* const dynamics = std::getenv("COHORT_TEST_DYNAMICS");
  if (dynamics != nullptr && std::string_view(dynamics) == "cohort")
    experiment.world.physics.dynamics = description::Dynamics::cohort;
  return experiment;
}

/// An experiment of worlds/experiments, run to its end with its controllers in this process.
class ShippedExperiment {
 public:
  /// `watch` is called at every tick boundary, after all robots have sensed.
  explicit ShippedExperiment(const std::string& name, std::optional<std::uint64_t> seed = {}, double seconds = 0.0,
                             std::function<void(const ShippedExperiment&)> watch = {})
      : experiment(with_dynamics_of_test(parsing::read_experiment(
            shipped_experiments / (name + ".yaml"), seed,
            seconds > 0.0 ? std::optional(std::chrono::nanoseconds(std::llround(seconds * 1e9))) : std::nullopt))),
        simulation(experiment, 2) {
    std::vector<std::unique_ptr<LoadedPlugin>> plugins;
    std::vector<ControllerKind> kinds;
    for (const description::Team& team : experiment.teams) {
      plugins.push_back(std::make_unique<LoadedPlugin>(team.controller, default_plugin_directories()));
      kinds.push_back(plugins.back()->kind());
    }
    const session::RunListener listener = {.boundary = [&] {
      if (watch) watch(*this);
    }};
    result = session::run_in_process(experiment, simulation, kinds, {}, listener, std::atomic<bool>(false));
    EXPECT_EQ(result.end, session::RunResult::End::finished) << result.error;
    EXPECT_TRUE(experiment.world.warnings.empty()) << experiment.world.warnings[0].text();
  }

  Eigen::Vector3d position(const std::string& object) const { return pose(object).position; }
  Pose pose(const std::string& object) const { return simulation.object_pose(*simulation.objects().find(object)); }
  bool has_quarantined() const {
    return std::any_of(result.events.begin(), result.events.end(),
                       [](const session::RunEvent& event) { return event.kind == "quarantined"; });
  }
  /// Returns the fraction of groups of bodies for which the solver did not converge.
  double unconverged() const {
    const physics::Convergence& convergence = simulation.convergence();
    return static_cast<double>(convergence.unconverged) / static_cast<double>(convergence.solved);
  }
  /// Returns the first value of a channel in the last observation of a robot.
  double reading(std::uint32_t robot, const std::string& channel) const {
    std::size_t offset = 0;
    for (const Channel& each : simulation.kinds()[simulation.kind_of(robot)].observation) {
      if (each.name == channel) return simulation.observation(robot)[offset];
      offset += each.size;
    }
    ADD_FAILURE() << "no channel " << channel;
    return 0.0;
  }
  int robots_that_grip() const {
    int count = 0;
    for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot)
      if (simulation.is_present(robot) && reading(robot, "gripper/0/gripping") == 1.0) ++count;
    return count;
  }
  double seconds() const { return std::chrono::duration<double>(simulation.time()).count(); }
  /// Returns the number of robots within `radius` [m] of a point in the horizontal plane.
  int robots_near(double x, double y, double radius) const {
    int count = 0;
    for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
      const Eigen::Vector3d at = simulation.robot_pose(robot).position;
      if (std::hypot(at.x() - x, at.y() - y) <= radius) ++count;
    }
    return count;
  }
  /// Returns the size of the largest group of robots, where robots with origins within `reach` [m] of each other belong
  /// to the same group.
  int largest_group(double reach) const {
    std::vector<int> group(simulation.robot_count(), -1);
    int largest = 0;
    for (std::uint32_t first = 0; first < group.size(); ++first) {
      if (group[first] >= 0) continue;
      std::vector<std::uint32_t> to_visit{first};
      group[first] = static_cast<int>(first);
      int size = 0;
      while (!to_visit.empty()) {
        const std::uint32_t robot = to_visit.back();
        to_visit.pop_back();
        ++size;
        for (std::uint32_t other = 0; other < group.size(); ++other) {
          if (group[other] >= 0) continue;
          const Eigen::Vector3d apart = simulation.robot_pose(robot).position - simulation.robot_pose(other).position;
          if (apart.norm() > reach) continue;
          group[other] = static_cast<int>(first);
          to_visit.push_back(other);
        }
      }
      largest = std::max(largest, size);
    }
    return largest;
  }

  description::Experiment experiment;
  Simulation simulation;
  session::RunResult result;
};

}  // namespace cohort::test
