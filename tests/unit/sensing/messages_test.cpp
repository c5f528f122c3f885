// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/worlds/sensing_world.hpp"

/// Messages from robot to robot, and the climate.
namespace cohort {
namespace {

using namespace test;

description::Model talking_robot(double range = 2.0, std::size_t capacity = 4) {
  description::Model model = tracked_robot();
  model.devices.push_back(description::RangeAndBearing{"rab", 1, {{0, 0, 0.03}}, range, 2, capacity, {}});
  return model;
}

TEST(RangeAndBearing, ReportsMessagesAndTheirDirections) {
  SensingWorld world;
  world.add(talking_robot(), "hearing", at(0, 0, 0, 0.5));
  world.add(talking_robot(), "talking", at(-0.6, 0.8, 0));
  world.command(1, "rab/0/sending", {1.0, 42.0, -7.5});
  EXPECT_EQ(world.read(0, "rab/0/count"), 0.0);
  world.step();
  EXPECT_EQ(world.read(0, "rab/0/count"), 1.0);
  EXPECT_NEAR(world.read(0, "rab/0/range"), 1.0, 1e-3);
  EXPECT_NEAR(world.read(0, "rab/0/bearing"), std::atan2(0.8, -0.6) - 0.5, 1e-3);
  EXPECT_NEAR(world.read(0, "rab/0/elevation"), 0.0, 1e-3);
  EXPECT_EQ(world.read(0, "rab/0/message", 0), 42.0);
  EXPECT_EQ(world.read(0, "rab/0/message", 1), -7.5);
  EXPECT_EQ(world.read(1, "rab/0/count"), 0.0) << "a robot does not hear itself";
  world.command(1, "rab/0/sending", {0.0});
  world.step();
  EXPECT_EQ(world.read(0, "rab/0/count"), 0.0);
  EXPECT_EQ(world.read(0, "rab/0/message"), 0.0);
}

TEST(RangeAndBearing, IsBlockedByRangeWallsAndOtherRobots) {
  SensingWorld world;
  world.add(talking_robot(), "hearing", at(0, 0, 0));
  world.add(talking_robot(1.5), "too far", at(0, 1.6, 0));
  world.add(talking_robot(), "behind a wall", at(0, -1, 0));
  world.add(static_shape("wall", description::Box{{1.0, 0.1, 0.4}}), "wall", at(0, -0.5, 0.2));
  world.add(talking_robot(), "in sight", at(0.5, 0, 0));
  world.add(talking_robot(), "hidden by it", at(1.0, 0, 0));
  for (std::uint32_t robot = 1; robot < 5; ++robot)
    world.command(robot, "rab/0/sending", {1.0, static_cast<double>(robot), 0.0});
  world.step();
  EXPECT_EQ(world.read(0, "rab/0/count"), 1.0);
  EXPECT_EQ(world.read(0, "rab/0/message"), 3.0);
}

TEST(RangeAndBearing, ReportsTheNearestIfMoreAreReceivedThanFit) {
  SensingWorld world;
  world.add(talking_robot(2.0, 3), "hearing", at(0, 0, 0));
  for (int i = 0; i < 6; ++i) {
    const double angle = 1.0 * i, distance = 1.2 - 0.1 * i;
    world.add(talking_robot(2.0, 3), "talking" + std::to_string(i),
              at(distance * std::cos(angle), distance * std::sin(angle), 0));
  }
  for (int i = 0; i < 6; ++i)
    world.command(static_cast<std::uint32_t>(i + 1), "rab/0/sending", {1.0, static_cast<double>(i), 0.0});
  world.step();
  EXPECT_EQ(world.read(0, "rab/0/count"), 3.0);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(world.read(0, "rab/" + std::to_string(i) + "/message"), 5.0 - static_cast<double>(i));
}

TEST(RangeAndBearing, AccumulatesMessagesBetweenDueTicks) {
  SensingWorld world;
  world.policy.period = 3;
  world.add(talking_robot(2.0, 8), "hearing", at(0, 0, 0));
  world.add(talking_robot(2.0, 8), "talking", at(0.5, 0, 0));
  for (int tick = 0; tick < 6; ++tick) {
    world.command(1, "rab/0/sending", {1.0, static_cast<double>(tick), 0.0});
    world.step();
  }
  // At tick 6: what was sent at ticks 3, 4 and 5; the newest first.
  EXPECT_EQ(world.read(0, "rab/0/count"), 3.0);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(world.read(0, "rab/" + std::to_string(i) + "/message"), 5.0 - static_cast<double>(i));
}

TEST(RangeAndBearing, ContinuesFromASnapshotBetweenTwoDeliveries) {
  SensingWorld world;
  world.policy.period = 4;
  world.add(talking_robot(2.0, 8), "hearing", at(0, 0, 0));
  world.add(talking_robot(2.0, 8), "talking", at(0.5, 0, 0));
  const auto run = [&](int from, int to) {
    for (int tick = from; tick < to; ++tick) {
      world.command(1, "rab/0/sending", {1.0, static_cast<double>(tick), 0.0});
      world.step();
    }
    return world.simulation().state_hash();
  };
  run(0, 6);
  const std::vector<std::byte> snapshot = world.simulation().save();
  const std::uint64_t whole = run(6, 12);
  world.begin_again(1);
  world.simulation().restore(snapshot);
  EXPECT_EQ(run(6, 12), whole);
}

TEST(ClimateSensor, ReadsTheAirAndNearbySources) {
  SensingWorld world;
  world.world().climate = {290.0, 0.4};
  description::Model robot = tracked_robot();
  robot.devices.push_back(description::ClimateSensor{"climate", 0, {0, 0, 0.1}, {}});
  world.add(robot, "robot", at(0, 0, 0));
  world.add_emitter("stove", description::ClimateSource{30.0, -0.2, 0.5}, at(0.8, 0, 0.7));
  world.add_emitter("pond", description::ClimateSource{-2.0, 0.3, 2.0}, at(0, 1.0, 0.1));
  const double stove = std::exp(-0.5 * (0.64 + 0.36) / 0.25), pond = std::exp(-0.5 / 4.0);
  EXPECT_NEAR(world.read(0, "climate/0/temperature"), 290.0 + 30.0 * stove - 2.0 * pond, 1e-9);
  EXPECT_NEAR(world.read(0, "climate/0/humidity"), 0.4 - 0.2 * stove + 0.3 * pond, 1e-9);
}

}  // namespace
}  // namespace cohort
