// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/worlds/small_world.hpp"

namespace cohort::test {
namespace {

using description::Box;
using Eigen::Vector3d;

constexpr double robot_mass = 0.7;

TEST(Scenes, ARobotOnItsBackLiesOnItsTurretAndItsTracksTurnInTheAir) {
  SmallWorld small;
  const auto robot = small.add(tracked_robot(), turned(0, 0, 0.11, Vector3d::UnitX(), M_PI));
  small.run(2.0);
  EXPECT_NEAR(small.position(robot).z(), 0.095, 1e-3) << "the height of its turret";
  EXPECT_LT(small.up(robot).z(), -0.999);
  const Vector3d before = small.position(robot);
  small.drive(robot, 0.2, 0.2);
  small.run(2.0);
  EXPECT_LT((small.position(robot) - before).norm(), 1e-3);
  EXPECT_EQ(small.world().device_state(robot, DeviceId{0}, 0).velocity, 0.2);
}

TEST(Scenes, ARobotOnItsSideLiesOnHullAndTurret) {
  SmallWorld small;
  const auto robot = small.add(tracked_robot(), turned(0, 0, 0.07, Vector3d::UnitX(), 1.5));
  small.run(3.0);
  EXPECT_LT(std::abs(small.up(robot).z()), 0.5);
  EXPECT_GT(small.position(robot).z(), 0.03) << "it sank";
  EXPECT_LT(small.velocity(robot).norm(), 0.05);
}

TEST(Scenes, ARobotTipsOverTheEdgeOfATableAndComesToRest) {
  SmallWorld small;
  small.add(static_shape("table", Box{{1.0, 1.0, 0.3}}), at(0, 0, 0.15));
  const auto robot = small.add(tracked_robot(), at(0.3, 0, 0.3));
  small.drive(robot, 0.15, 0.15);
  small.run(3.0);
  small.drive(robot, 0.0, 0.0);
  small.run(3.0);
  EXPECT_GT(small.position(robot).x(), 0.5);
  EXPECT_GT(small.position(robot).z(), -1e-3);
  EXPECT_LT(small.position(robot).z(), 0.13);
  EXPECT_LT(small.velocity(robot).norm(), 0.02);
}

TEST(Scenes, ARobotClimbsAStepLowerThanItsWheelsAndIsStoppedByAHigherOne) {
  SmallWorld low;
  low.add(static_shape("step", Box{{1.0, 1.0, 0.008}}), at(0.65, 0, 0.004));
  const auto climber = low.add(tracked_robot(), at(0, 0, 0));
  low.drive(climber, 0.1, 0.1);
  low.run(5.0);
  EXPECT_GT(low.position(climber).x(), 0.35);
  EXPECT_NEAR(low.position(climber).z(), 0.008, 1e-3);

  SmallWorld high;
  high.add(static_shape("step", Box{{1.0, 1.0, 0.08}}), at(0.65, 0, 0.04));
  const auto stopped = high.add(tracked_robot(), at(0, 0, 0));
  high.drive(stopped, 0.1, 0.1);
  high.run(5.0);
  EXPECT_LT(high.position(stopped).x(), 0.15 - 0.04);
  EXPECT_NEAR(high.position(stopped).z(), 0.0, 2e-3);
}

TEST(Scenes, ARobotFallsIntoATroughWiderThanItself) {
  SmallWorld small;
  small.add(static_shape("left", Box{{1.0, 1.0, 0.1}}), at(-0.6, 0, 0.05));
  small.add(static_shape("right", Box{{1.0, 1.0, 0.1}}), at(0.6, 0, 0.05));
  const auto robot = small.add(tracked_robot(), at(-0.3, 0, 0.1));
  small.drive(robot, 0.1, 0.1);
  small.run(8.0);
  EXPECT_GT(small.position(robot).x(), -0.1);
  EXPECT_LT(small.position(robot).x(), 0.1);
  EXPECT_LT(small.position(robot).z(), 0.095);
}

TEST(Scenes, ARobotCrossesASlitNarrowerThanItsTracks) {
  SmallWorld small;
  small.add(static_shape("left", Box{{1.0, 1.0, 0.1}}), at(-0.515, 0, 0.05));
  small.add(static_shape("right", Box{{1.0, 1.0, 0.1}}), at(0.515, 0, 0.05));
  const auto robot = small.add(tracked_robot(), at(-0.3, 0, 0.1));
  small.drive(robot, 0.1, 0.1);
  small.run(6.0);
  EXPECT_GT(small.position(robot).x(), 0.25);
  EXPECT_NEAR(small.position(robot).z(), 0.1, 2e-3);
}

TEST(Scenes, ARobotDrivesUpASlopeAndStandsOnIt) {
  constexpr double slope = 0.2;
  SmallWorld small;
  small.add(static_shape("ramp", Box{{4.0, 1.0, 0.1}}), turned(0, 0, 0, Vector3d::UnitY(), -slope));
  const Vector3d along(std::cos(slope), 0, std::sin(slope));
  const Vector3d normal(-std::sin(slope), 0, std::cos(slope));
  const Vector3d start = 0.05 * normal + along;
  const auto robot = small.add(tracked_robot(), turned(start.x(), 0, start.z(), Vector3d::UnitY(), -slope));
  small.run(1.0);
  const Vector3d settled = small.position(robot);
  small.run(5.0);
  EXPECT_LT((small.position(robot) - settled).norm(), 0.4e-3) << "creep in 5 s";
  // To stand still, the drives hold the weight along the slope, shared by both sides.
  const double holding = small.world().device_state(robot, DeviceId{0}, 0).effort;
  EXPECT_NEAR(2.0 * holding, robot_mass * g * std::sin(slope), 0.01);
  small.drive(robot, 0.05, 0.05);
  small.run(4.0);
  EXPECT_NEAR((small.position(robot) - settled).dot(along), 0.2, 0.01);
}

// Returns a board on the floor, as thick as the tracks can climb.
description::Model board(description::Surface surface) {
  const Vector3d size(0.5, 0.4, 0.01);
  return loose("board", Box{size}, solid_box(0.5, size), surface);
}

TEST(Scenes, ARobotDrivesOverALooseBoard) {
  SmallWorld small;
  const auto plank = small.add(board({1.0, 0.0}), at(0.4, 0, 0.005));
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  small.drive(robot, 0.1, 0.1);
  small.run(4.0);
  EXPECT_NEAR(small.position(robot).x(), 0.4, 0.05);
  EXPECT_NEAR(small.position(robot).z(), 0.01, 2e-3) << "on top of the board";
  small.run(5.0);
  EXPECT_GT(small.position(robot).x(), 0.8);
  EXPECT_NEAR(small.position(robot).z(), 0.0, 2e-3) << "down again";
  EXPECT_NEAR(small.position(plank).z(), 0.005, 1e-3);
}

TEST(Scenes, ARobotThatAcceleratesOnALooseBoardPushesItBack) {
  SmallWorld small(world_with_floor(0.0));
  const auto plank = small.add(board({0.0, 0.0}), at(0, 0, 0.005));
  small.description.models.edit(small.description.models.size() - 1).links[0].collisions[0].surface.friction =
      1.0;  // the floor has none
  const auto robot = small.add(tracked_robot(), at(0, 0, 0.01));
  small.run(0.5);
  small.drive(robot, 0.1, 0.1);
  small.run(0.5);
  const double forwards = robot_mass * small.velocity(robot).x();
  EXPECT_GT(forwards, 0.01);
  EXPECT_NEAR(0.5 * small.velocity(plank).x(), -forwards, 1e-4) << "momentum";
  EXPECT_NEAR(small.velocity(robot).x() - small.velocity(plank).x(), 0.1, 1e-3) << "velocity over the board";
  EXPECT_NEAR(small.world().device_state(robot, DeviceId{0}, 0).velocity, 0.1, 1e-3);
}

TEST(Scenes, ARobotPushesALooseBoxAsFarAsItDrives) {
  SmallWorld small;
  const Vector3d size(0.1, 0.1, 0.1);
  const auto box = small.add(loose("box", Box{size}, solid_box(0.1, size), {0.2, 0.0}), at(0.15, 0, 0.05));
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  small.drive(robot, 0.1, 0.1);
  small.run(4.0);
  EXPECT_NEAR(small.position(robot).x(), 0.4, 0.01);
  EXPECT_NEAR(small.position(box).x(), small.position(robot).x() + 0.058 + 0.05, 3e-3);
  EXPECT_NEAR(small.position(box).z(), 0.05, 1e-3);
}

TEST(Scenes, SmallBodiesRestOnAVeryLargeMovingBody) {
  SmallWorld small;
  const Vector3d raft_size(6.0, 6.0, 0.5);
  const auto raft = small.add(loose("raft", Box{raft_size}, solid_box(400.0, raft_size), {0.0, 0.0}), at(0, 0, 0.25));
  small.description.models.edit(small.description.models.size() - 1).links[0].collisions[0].surface.friction = 1.0;
  small.description.models.edit(0).links[0].collisions[0].surface.friction = 0.0;
  std::vector<BodyId> balls;
  balls.reserve(20);
  for (int i = 0; i < 20; ++i)
    balls.push_back(small.add(loose("ball", description::Sphere{0.02}, solid_sphere(0.03, 0.02)),
                              at(-2.0 + 0.2 * i, 0.1 * (i % 3), 0.52)));
  const auto robot = small.add(tracked_robot(), at(0, -1.0, 0.5));
  small.run(1.0);
  for (const auto ball : balls) EXPECT_NEAR(small.position(ball).z(), 0.52, 1e-3);
  EXPECT_NEAR(small.position(robot).z(), 0.5, 1e-3);
  EXPECT_NEAR(small.position(raft).z(), 0.25, 1e-3);
}

}  // namespace
}  // namespace cohort::test
