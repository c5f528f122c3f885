// SPDX-License-Identifier: Apache-2.0

// Results of the experiments with sensors and tracks, in numbers, for three seeds each.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "tests/support/worlds/shipped_experiment.hpp"

namespace cohort {
namespace {

using namespace test;

// Records the positions and the tilt of robots.
struct Watch {
  double farthest = 0.0;                // along x or y [m]
  double lowest = 1e9;                  // [m]
  std::vector<double> least_upright;    // by robot
  std::set<std::pair<int, int>> cells;  // cells of 25 cm that any robot visited

  void operator()(const ShippedExperiment& run) {
    constexpr double cell = 0.25;
    least_upright.resize(run.simulation.robot_count(), 1.0);
    for (std::uint32_t robot = 0; robot < run.simulation.robot_count(); ++robot) {
      const Pose X_WL = run.simulation.robot_pose(robot);
      farthest = std::max(farthest, X_WL.position.head<2>().cwiseAbs().maxCoeff());
      lowest = std::min(lowest, X_WL.position.z());
      least_upright[robot] = std::min(least_upright[robot], (X_WL.orientation * Eigen::Vector3d::UnitZ()).z());
      cells.insert({static_cast<int>(std::floor(X_WL.position.x() / cell)),
                    static_cast<int>(std::floor(X_WL.position.y() / cell))});
    }
  }
};

class ObstacleAvoidance : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Experiments, ObstacleAvoidance, ::testing::Values(1, 2, 3));

TEST_P(ObstacleAvoidance, RobotsCoverTheArenaWithFewContacts) {
  Watch watch;
  const ShippedExperiment run("obstacle_avoidance", GetParam(), 0.0, std::ref(watch));
  EXPECT_LT(watch.farthest, 2.0 - 0.058 + 0.005) << "within the walls";
  EXPECT_GT(*std::ranges::min_element(watch.least_upright), 0.99);
  EXPECT_GT(watch.cells.size(), 200u) << "of 256";
  const TouchCounts& touches = run.simulation.touches();
  EXPECT_LT(static_cast<double>(touches.obstacles + touches.robots), 0.02 * static_cast<double>(touches.robot_ticks));
}

class RoughTerrain : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Experiments, RoughTerrain, ::testing::Values(1, 2, 3));

TEST_P(RoughTerrain, RobotsStayUprightAndSomeMoveAround) {
  Watch watch;
  const ShippedExperiment run("rough_terrain", GetParam(), 0.0, std::ref(watch));
  EXPECT_FALSE(run.has_quarantined());
  EXPECT_GT(watch.lowest, -0.02);
  double moved = 0.0;
  for (std::uint32_t robot = 0; robot < run.simulation.robot_count(); ++robot)
    moved = std::max(
        moved, (run.simulation.robot_pose(robot).position - run.experiment.world.robot(robot).X_WM.position).norm());
  const auto fallen = std::ranges::count_if(watch.least_upright, [](double up) { return up < 0.5; });
  EXPECT_LE(fallen, 1) << "of 8: one that was set down where it is steep";
  EXPECT_GT(moved, 0.3);
}

class Phototaxis : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Experiments, Phototaxis, ::testing::Values(1, 2, 3));

TEST_P(Phototaxis, LampsDetermineTheNumberOfGroups) {
  constexpr double east = 1.1, west = -1.1, radius = 0.8;
  const auto look = [&](const ShippedExperiment& run) {
    const double time = run.seconds();
    const int at_east = run.robots_near(east, 0.0, radius);
    const int at_west = run.robots_near(west, 0.0, radius);
    if (time == 89.0) {
      EXPECT_EQ(at_east + at_west, 20) << "all are at one of the two";
      EXPECT_GE(std::min(at_east, at_west), 5) << "and both have a group";
    }
    if (time == 209.0) {
      EXPECT_GE(at_west, 18) << "nearly all are at the one that is on";
    }
    if (time == 300.0) {
      EXPECT_LE(at_west, 8) << "they have spread";
      EXPECT_LE(at_east, 8);
    }
  };
  const ShippedExperiment run("phototaxis", GetParam(), 0.0, look);
  EXPECT_EQ(run.seconds(), 300.0);
  EXPECT_FALSE(run.has_quarantined());
}

// The largest group of one run has 5 to 20 robots.
TEST(Aggregation, SmallGroupsBecomeLargeOnes) {
  constexpr double reach = 0.25;
  int sum = 0, looks = 0;
  for (const std::uint64_t seed : {1, 2}) {
    int at_first = 0;
    const auto look = [&](const ShippedExperiment& run) {
      if (run.seconds() == 0.0) at_first = run.largest_group(reach);
      if (run.seconds() < 300.0 || run.simulation.tick() % 500 != 0) return;
      sum += run.largest_group(reach);
      ++looks;
    };
    const ShippedExperiment run("aggregation", seed, 0.0, look);
    EXPECT_LE(at_first, 4) << "seed " << seed;
  }
  EXPECT_GE(static_cast<double>(sum) / looks, 8.0) << "of 20, over the last 100 s of each run";
}

}  // namespace
}  // namespace cohort
