// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/hosting/plugin_loader.hpp"
#include "server/description/experiment.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/run/roster.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

// The whole minute of the demo, checked at every tick.
class DemoRun : public ::testing::Test {
 protected:
  static constexpr double half_arena = 2.0;       // inner half width of worlds/arenas/obstacles.sdf [m]
  static constexpr double turret_radius = 0.058;  // [m]
  static constexpr double cell = 0.25;            // size of a cell of the coverage map [m]

  static void SetUpTestSuite() {
    const description::Experiment experiment = parsing::read_experiment(demo_experiment());
    Simulation simulation(experiment, 2);
    const LoadedPlugin plugin("obstacle_avoidance", default_plugin_directories());
    ControllerHost host(plugin.plugin());
    wire::Admit admit;
    admit.step_ns = experiment.world.step.count();
    session::admit_robots(admit, experiment, simulation, experiment.teams[0].robots);
    host.start(admit, session::describe_kinds(simulation));

    robots = simulation.robot_count();
    const auto ticks = static_cast<std::uint64_t>(experiment.duration / experiment.world.step);
    std::vector<double> values;
    for (std::uint64_t tick = 0; tick < ticks; ++tick) {
      values.clear();
      for (std::uint32_t robot = 0; robot < robots; ++robot) {
        const auto observation = simulation.observation(robot);
        values.insert(values.end(), observation.begin(), observation.end());
      }
      wire::Observation frame;
      frame.tick = tick;
      frame.robots = experiment.teams[0].robots;
      frame.values = values;
      std::span<const double> answer = host.answer(frame);
      for (std::uint32_t robot = 0; robot < robots; ++robot) {
        const std::size_t size = simulation.kinds()[simulation.kind_of(robot)].command_size;
        ASSERT_FALSE(simulation.check_command(robot, answer.first(size)));
        simulation.set_command(robot, answer.first(size));
        answer = answer.subspan(size);
      }
      simulation.step();
      for (std::uint32_t robot = 0; robot < robots; ++robot) watch(simulation.robot_pose(robot));
    }
    touches = simulation.touches();
    convergence = simulation.convergence();
    state_hash = simulation.state_hash();
  }

  static void watch(const Pose& pose) {
    farthest = std::max(farthest, pose.position.head<2>().cwiseAbs().maxCoeff());
    lowest = std::min(lowest, pose.position.z());
    highest = std::max(highest, pose.position.z());
    least_upright = std::min(least_upright, (pose.orientation * Eigen::Vector3d::UnitZ()).z());
    visited.insert({static_cast<int>(std::floor(pose.position.x() / cell)),
                    static_cast<int>(std::floor(pose.position.y() / cell))});
  }

  static inline std::uint32_t robots = 0;
  static inline double farthest = 0.0;
  static inline double lowest = 0.0;
  static inline double highest = 0.0;
  static inline double least_upright = 1.0;
  static inline std::set<std::pair<int, int>> visited;
  static inline TouchCounts touches;
  static inline physics::Convergence convergence;
  static inline std::uint64_t state_hash = 0;
};

TEST_F(DemoRun, NoRobotLeavesTheArena) { EXPECT_LE(farthest, half_arena - turret_radius + 0.005); }

TEST_F(DemoRun, NoRobotSinksTakesOffOrTipsOver) {
  EXPECT_GT(lowest, -0.002);
  EXPECT_LT(highest, 0.002);
  EXPECT_GT(least_upright, 0.99);
}

TEST_F(DemoRun, RobotsTouchObstaclesInUnderTwoPercentOfTheirTicks) {
  EXPECT_EQ(touches.robot_ticks, 16u * 6000u);
  EXPECT_LT(static_cast<double>(touches.obstacles), 0.02 * static_cast<double>(touches.robot_ticks));
}

TEST_F(DemoRun, IsSolvedToAMillionthInAllSteps) {
  EXPECT_GT(convergence.solved, 6000u);
  EXPECT_EQ(convergence.unconverged, 0u);
}

TEST_F(DemoRun, RobotsCoverTheArena) {
  const double cells = std::pow(2 * half_arena / cell, 2);
  // The robots reach all but some corners: 242 of 256 cells when this was written.
  EXPECT_GT(static_cast<double>(visited.size()), 0.85 * cells) << "of " << cells;
  RecordProperty("cells_visited", static_cast<int>(visited.size()));
  std::printf("visited %zu of %.0f cells; touched obstacles in %.3f %% and robots in %.3f %% of robot-ticks\n",
              visited.size(), cells,
              100.0 * static_cast<double>(touches.obstacles) / static_cast<double>(touches.robot_ticks),
              100.0 * static_cast<double>(touches.robots) / static_cast<double>(touches.robot_ticks));
}

TEST_F(DemoRun, HasTheHashInTheReadmeAndItsPicture) {
  char text[17];
  std::snprintf(text, sizeof text, "%016lx", static_cast<unsigned long>(state_hash));
  for (const char* file : {"README.md", "docs/images/obstacle_avoidance.svg"}) {
    EXPECT_NE(read_file(std::string(COHORT_SOURCE_DIR "/") + file).find(text), std::string::npos)
        << file << " is out of date: tools/demo --plot docs/images/obstacle_avoidance.svg gives the new picture, hash "
        << text;
  }
}

}  // namespace
}  // namespace cohort::test
