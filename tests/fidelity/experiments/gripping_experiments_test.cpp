// SPDX-License-Identifier: Apache-2.0

// Results of the gripping experiments, in numbers, for three seeds each.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "server/core/random.hpp"
#include "server/parsing/world/read_world.hpp"
#include "tests/support/process.hpp"
#include "tests/support/worlds/sensing_world.hpp"
#include "tests/support/worlds/shipped_experiment.hpp"

namespace cohort {
namespace {

using namespace test;

constexpr std::size_t turret = 1;

// Returns the path, without its extension, of a copy of a shipped experiment in which it or its arena has `to` instead
// of `from`.
std::string changed_experiment(const ScratchFolder& folder, const std::string& experiment, const std::string& arena,
                               const std::string& from, const std::string& to) {
  const std::filesystem::path worlds = shipped_experiments.parent_path();
  std::filesystem::copy(worlds / "robots", folder / "robots", std::filesystem::copy_options::recursive);
  bool is_changed = false;
  for (const std::string& file : {"arenas/" + arena + ".yaml", "experiments/" + experiment + ".yaml"}) {
    std::string text = read_file(worlds / file);
    if (const std::size_t at = text.find(from); at != std::string::npos) {
      text.replace(at, from.size(), to);
      is_changed = true;
    }
    std::filesystem::create_directories((folder / file).parent_path());
    write_file(folder / file, text);
  }
  EXPECT_TRUE(is_changed) << from;
  return folder / ("experiments/" + experiment);
}

TEST(Chain, OfOneRobotFallsIntoTheTrough) {
  const ScratchFolder folder;
  const std::string alone = changed_experiment(folder, "chain", "wide_trough", "count: 4", "count: 1");
  const ShippedExperiment run(alone, 1);
  EXPECT_EQ(run.simulation.robot_count(), 1u);
  EXPECT_LT(run.simulation.robot_pose(0).position.z(), 0.19);
}

class Chain : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Experiments, Chain, ::testing::Values(1, 2, 3));

TEST_P(Chain, CrossesTheTrough) {
  constexpr double floor = 0.2, far_side = 0.65;
  double lowest = floor;
  int gripping_at_the_edge = 0;
  const auto look = [&](const ShippedExperiment& run) {
    double foremost = -1e9;
    for (std::uint32_t robot = 0; robot < run.simulation.robot_count(); ++robot) {
      const Eigen::Vector3d at = run.simulation.robot_pose(robot).position;
      lowest = std::min(lowest, at.z());
      foremost = std::max(foremost, at.x());
    }
    if (foremost > 0.5 && foremost < far_side) gripping_at_the_edge = run.robots_that_grip();
  };
  const ShippedExperiment run("chain", GetParam(), 0.0, look);
  EXPECT_EQ(run.result.stop_reason, "inside: 4 objects");
  EXPECT_EQ(gripping_at_the_edge, 3) << "all but the first";
  EXPECT_GT(lowest, floor - 0.015) << "no robot hangs deeper";
  EXPECT_LT(run.unconverged(), 0.05);
  for (std::uint32_t robot = 0; robot < 4; ++robot) {
    EXPECT_GT(run.simulation.robot_pose(robot).position.x(), far_side + 0.1);
    EXPECT_NEAR(run.simulation.robot_pose(robot).position.z(), floor, 0.002);
  }
}

class Lifting : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Experiments, Lifting, ::testing::Values(1, 2, 3));

TEST_P(Lifting, AnSbotHoldsAnotherInTheAirAndPutsItDownAgain) {
  double held = 0.0;          // [s]
  double lifter_moved = 0.0;  // [m]
  const auto look = [&](const ShippedExperiment& run) {
    const double step = std::chrono::duration<double>(run.experiment.world.step).count();
    // Returns the lowest point of the tracks.
    const Pose X_WL = run.pose("load/sbot_detailed_0");
    double lowest = 1e9;
    for (const double x : {-0.04, 0.04})
      for (const double y : {-0.04, 0.04}) lowest = std::min(lowest, (X_WL * Eigen::Vector3d(x, y, 0.0)).z());
    if (lowest > 0.02) held += step;
    lifter_moved = std::max(lifter_moved, run.position("lifter/sbot_detailed_0").z());
  };
  const ShippedExperiment run("lifting", GetParam(), 0.0, look);
  EXPECT_GT(held, 5.0);
  EXPECT_LT(lifter_moved, 0.002) << "the anchor keeps the lifter on the ground";
  const Pose X_WL = run.pose("load/sbot_detailed_0");
  EXPECT_NEAR(X_WL.position.z(), 0.0, 0.001);
  EXPECT_GT((X_WL.orientation * Eigen::Vector3d::UnitZ()).z(), 0.999);
  EXPECT_EQ(run.unconverged(), 0.0);
}

TEST(Lifting, WithoutAnAnchorTheLifterTipsOver) {
  const ScratchFolder folder;
  const std::string alone = changed_experiment(folder, "lifting", "lifting", "anchor/*, controller: lifting",
                                               "anchor/*, controller: constant");
  double least_upright = 1.0;
  double highest_load = 0.0;
  const ShippedExperiment run(alone, 1, 0.0, [&](const ShippedExperiment& its) {
    least_upright =
        std::min(least_upright, (its.pose("lifter/sbot_detailed_0").orientation * Eigen::Vector3d::UnitZ()).z());
    highest_load = std::max(highest_load, its.position("load/sbot_detailed_0").z());
  });
  EXPECT_LT(least_upright, std::cos(0.2)) << "it tips up itself instead";
  EXPECT_LT(highest_load, 0.005);
}

// Returns the robot whose ring is in a robot's gripper.
std::uint32_t held_by(const ShippedExperiment& run, std::uint32_t robot) {
  const auto X_WT = [&](std::uint32_t each) {
    const BodyId body{*run.simulation.objects().find(run.simulation.robot_name(each))};
    return run.simulation.world().link_pose(body, LinkId{turret});
  };
  std::uint32_t nearest = robot;
  double least = 1e9;
  const Eigen::Vector3d jaw_W = X_WT(robot) * Eigen::Vector3d(0.058, 0.0, 0.02);
  for (std::uint32_t other = 0; other < run.simulation.robot_count(); ++other) {
    if (other == robot) continue;
    const double distance = (X_WT(other) * Eigen::Vector3d(0.0, 0.0, 0.02) - jaw_W).norm();
    if (distance < least) {
      least = distance;
      nearest = other;
    }
  }
  return nearest;
}

class Assembly : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Experiments, Assembly, ::testing::Values(1, 2, 3));

TEST_P(Assembly, SbotsGripEachOtherAndMoveTogether) {
  constexpr double west = -0.9, east = 0.9;
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> grips;  // pairs of robots and the distance between the two
  int at_west = 0;
  double stretched = 0.0;
  const auto look = [&](const ShippedExperiment& run) {
    const auto apart = [&](std::uint32_t a, std::uint32_t b) {
      return (run.simulation.robot_pose(a).position - run.simulation.robot_pose(b).position).norm();
    };
    if (run.seconds() == 89.0) {
      at_west = run.robots_near(west, 0.0, 0.7);
      for (std::uint32_t robot = 0; robot < run.simulation.robot_count(); ++robot) {
        if (run.reading(robot, "gripper/0/gripping") != 1.0) continue;
        const std::uint32_t other = held_by(run, robot);
        grips[{robot, other}] = apart(robot, other);
      }
    }
    for (const auto& [pair, distance] : grips)
      stretched = std::max(stretched, std::abs(apart(pair.first, pair.second) - distance));
  };
  const ShippedExperiment run("assembly", GetParam(), 0.0, look);
  EXPECT_GE(at_west, 10);
  EXPECT_GE(grips.size(), 6u) << "of 12";
  EXPECT_LT(stretched, 0.005) << "those that grip stay as they are on all of the way";
  for (const auto& [pair, distance] : grips)
    EXPECT_EQ(run.reading(pair.first, "gripper/0/gripping"), 1.0) << "no robot lets go";
  EXPECT_GE(run.robots_near(east, 0.0, 0.7), 8) << "those at the front stop first, and hold the others";
  EXPECT_FALSE(run.has_quarantined());
  EXPECT_LT(run.unconverged(), 0.1);
}

class Retrieval : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Experiments, Retrieval, ::testing::Values(1, 2, 3));

TEST_P(Retrieval, SeveralRobotsMoveALoadThatTwoCannot) {
  double moved_by_two = 0.0;
  const auto look = [&](const ShippedExperiment& run) {
    if (run.robots_that_grip() <= 2)
      moved_by_two = std::max(moved_by_two, (run.position("prey") - Eigen::Vector3d(-0.4, 0.0, 0.0)).norm());
  };
  const ShippedExperiment run("retrieval", GetParam(), 0.0, look);
  EXPECT_EQ(run.result.stop_reason, "inside: 1 object");
  EXPECT_LT(moved_by_two, 0.01);
  EXPECT_GE(run.robots_that_grip(), 3);
  EXPECT_LT(run.unconverged(), 0.01);
}

TEST(GrippingSwarm, StaysConnectedUnderRandomPullsForFiveMinutes) {
  constexpr int side = 5;
  constexpr double spacing = 0.13;
  constexpr int ticks_a_pull = 200, ticks = 30000;
  const description::World shipped = parsing::read_world_or_model(COHORT_SOURCE_DIR "/worlds/robots/sbot/model.sdf", 1);
  const RandomStream random(1, "swarm", "pull");
  SensingWorld world(2);
  for (int i = 0; i < side * side; ++i) {
    const double yaw = 2.0 * M_PI * random.uniform(0, static_cast<std::uint32_t>(i));
    const int column = i % side, row = i / side;
    world.add(shipped.robot_model(0), "robot_" + std::to_string(i), at(spacing * column, spacing * row, 0.0, yaw));
  }
  const Simulation& simulation = world.simulation();
  const auto gripping = [&] {
    int count = 0;
    for (std::uint32_t robot = 0; robot < side * side; ++robot)
      if (world.read(robot, "gripper/0/gripping") == 1.0) ++count;
    return count;
  };
  int at_first = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    if (tick % ticks_a_pull == 0)
      for (std::uint32_t robot = 0; robot < side * side; ++robot) {
        const auto pull = 1u + static_cast<std::uint64_t>(tick) / ticks_a_pull;
        world.command(robot, "gripper/0/opening", {0.0});
        world.command(robot, "treel/left/velocity", {0.4 * random.uniform(pull, 3 * robot) - 0.2});
        world.command(robot, "treel/right/velocity", {0.4 * random.uniform(pull, 3 * robot + 1) - 0.2});
        world.command(robot, "turret/0/velocity", {2.0 * random.uniform(pull, 3 * robot + 2) - 1.0});
      }
    world.step();
    if (tick == 2 * ticks_a_pull) at_first = gripping();
    if (tick % 100 != 0) continue;
    ASSERT_TRUE(simulation.quarantined().empty()) << tick;
    for (std::uint32_t robot = 0; robot < side * side; ++robot) {
      const Eigen::Vector3d at = simulation.robot_pose(robot).position;
      ASSERT_TRUE(at.allFinite());
      ASSERT_LT(std::abs(at.z()), 0.02) << "robot " << robot << " at tick " << tick;
    }
  }
  EXPECT_GE(at_first, 10) << "of 25, where they stand at random";
  EXPECT_GE(gripping(), at_first) << "no robot is torn away";
  RecordProperty("gripping", gripping());
  // They grasped within the depth of the jaw and hold there.
  for (std::uint32_t robot = 0; robot < side * side; ++robot) {
    if (world.read(robot, "gripper/0/gripping") != 1.0) continue;
    const auto X_WT = [&](std::uint32_t each) {
      const BodyId body{*simulation.objects().find(simulation.robot_name(each))};
      return simulation.world().link_pose(body, LinkId{turret});
    };
    const Eigen::Vector3d jaw_W = X_WT(robot) * Eigen::Vector3d(0.058, 0.0, 0.02);
    double least = 1e9;
    for (std::uint32_t other = 0; other < side * side; ++other)
      if (other != robot)
        least = std::min(least, std::abs((X_WT(other) * Eigen::Vector3d(0.0, 0.0, 0.02) - jaw_W).norm() - 0.058));
    EXPECT_LT(least, 0.02 + 0.005) << "robot " << robot;
  }
}

}  // namespace
}  // namespace cohort
