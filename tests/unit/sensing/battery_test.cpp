// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/worlds/sensing_world.hpp"
#include "tests/support/worlds/small_world.hpp"

namespace cohort {
namespace {

using namespace test;

description::Model fed_robot(double capacity, double idle_power, double efficiency = 1.0) {
  description::Model model = tracked_robot();
  description::Battery battery;
  battery.name = "battery";
  battery.capacity = capacity;
  battery.idle_power = idle_power;
  battery.motor_efficiency = efficiency;
  model.devices.push_back(battery);
  return model;
}

TEST(Battery, SuppliesItsIdlePowerAtRest) {
  SensingWorld world;
  world.add(fed_robot(10.0, 2.0), "robot", at(0, 0, 0));
  EXPECT_EQ(world.read(0, "battery/0/charge"), 1.0);
  world.step(100);
  EXPECT_NEAR(world.read(0, "battery/0/charge"), 1.0 - 2.0 / 10.0, 1e-6);
  EXPECT_NEAR(world.read(0, "battery/0/power"), 2.0, 1e-5);
}

// The energy for accelerating is at least the kinetic energy, m v^2 / 2, over the efficiency.
TEST(Battery, SuppliesThePowerOfTracksOnTheirLoad) {
  SensingWorld world;
  world.add(fed_robot(10.0, 0.0, 0.5), "robot", at(0, 0, 0));
  world.command(0, "treel/left/velocity", {0.2});
  world.command(0, "treel/right/velocity", {0.2});
  world.step(100);
  const double kinetic = 0.5 * 0.7 * 0.2 * 0.2;
  const double given = 10.0 * (1.0 - world.read(0, "battery/0/charge"));
  EXPECT_GT(given, 0.95 * kinetic / 0.5);
  EXPECT_LT(given, 2.2 * kinetic / 0.5) << "friction while it gets going takes as much at the most";
}

TEST(Battery, SuppliesThePowerOfRotorsOnTheAir) {
  SensingWorld world;
  description::Model model = fed_robot(1000.0, 0.0, 0.5);
  description::Rotor rotor;
  rotor.name = "rotor";
  rotor.max_velocity = 500.0;
  rotor.motor_constant = 1e-6;
  rotor.moment_constant = 0.02;
  rotor.time_constant_up = 0.05;
  model.devices.push_back(rotor);
  world.add(model, "robot", at(0, 0, 0));
  world.command(0, "rotor/0/velocity", {400.0});
  world.step(100);
  EXPECT_NEAR(world.read(0, "rotor/0/velocity"), 400.0, 1e-3);
  EXPECT_NEAR(world.read(0, "battery/0/power"), 0.02 * 1e-6 * 400.0 * 400.0 * 400.0 / 0.5, 1e-3);
}

// m v^2: as much as its kinetic energy is turned into heat while it slips.
TEST(Battery, SuppliesThePowerOfABeltOnItsLoad) {
  constexpr double mass = 2.0, speed = 0.9, efficiency = 0.5;
  const Eigen::Vector3d size(4.0, 1.0, 0.1);
  SensingWorld world;
  description::Model model = fed_robot(100.0, 0.0, efficiency);
  const description::Battery battery = std::get<description::Battery>(model.devices.back());
  model = loose("conveyor", description::Box{size}, solid_box(20.0, size), {0.3, 0.0});
  model.joints.push_back(
      joint_of("tie", description::JointType::fixed, description::Joint::world, 0, Eigen::Vector3d::UnitZ()));
  model.devices = {battery, description::Belt{"belt", 0, Eigen::Vector3d::UnitY(), 10.0}};
  world.add(model, "conveyor", at(0, 0, 1));
  const Eigen::Vector3d crate(0.2, 0.2, 0.1);
  world.add(loose("crate", description::Box{crate}, solid_box(mass, crate)), "crate", at(0, 0, 1.1));
  world.command(0, "belt/0/velocity", {speed});
  world.step(100);
  const double given = 100.0 * (1.0 - world.read(0, "battery/0/charge"));
  EXPECT_NEAR(given, mass * speed * speed / efficiency, 0.03 * mass * speed * speed / efficiency);
}

// At a constant velocity up a slope: m g v sin.
TEST(Battery, SuppliesThePowerOfBeltTracksOnTheVehicle) {
  constexpr double mass = 10.0, speed = 0.2, efficiency = 0.5, slope = 0.3;
  const Eigen::Vector3d size(0.6, 0.5, 0.1);
  SensingWorld world;
  description::Model model = fed_robot(1000.0, 0.0, efficiency);
  const description::Battery battery = std::get<description::Battery>(model.devices.back());
  model = loose("vehicle", description::Box{size}, solid_box(mass, size), {0.8, 0.0});
  description::TrackedDrive drive;
  drive.name = "drive";
  drive.left_links = {0};
  drive.track_separation = 0.4;
  drive.max_linear = 1.0;
  model.devices = {battery, drive};
  const Pose X_WG = turned(0, 0, 3, Eigen::Vector3d::UnitY(), -slope);
  world.add(description::static_shape("slope", description::Box{{8, 2, 0.2}}), "slope", X_WG * Pose{{0, 0, -0.1}});
  world.add(model, "vehicle", X_WG * Pose{{0, 0, 0.05}});
  world.command(0, "drive/0/linear", {speed});
  world.step(100);
  const double before = world.read(0, "battery/0/charge");
  world.step(100);
  const double given = 1000.0 * (before - world.read(0, "battery/0/charge"));
  EXPECT_NEAR(given, mass * g * std::sin(slope) * speed / efficiency, 0.05 * given);
}

TEST(Battery, StopsTheRobotWhenItIsEmpty) {
  SensingWorld world;
  world.add(fed_robot(1.0, 2.0), "robot", at(0, 0, 0));
  for (int tick = 0; tick < 150; ++tick) {
    world.command(0, "treel/left/velocity", {0.1, 0.1});
    world.step();
    if (tick == 30) {
      EXPECT_NEAR(world.read(0, "treel/left/velocity"), 0.1, 1e-3);
    }
  }
  EXPECT_EQ(world.read(0, "battery/0/charge"), 0.0);
  EXPECT_EQ(world.read(0, "battery/0/power"), 0.0);
  EXPECT_NEAR(world.read(0, "treel/left/velocity"), 0.0, 1e-3);
}

}  // namespace
}  // namespace cohort
