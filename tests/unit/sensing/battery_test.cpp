#include <gtest/gtest.h>

#include "tests/support/sensing_world.hpp"

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

TEST(Battery, GivesItsIdlePowerToARobotAtRest) {
  SensingWorld world;
  world.add(fed_robot(10.0, 2.0), "robot", at(0, 0, 0));
  EXPECT_EQ(world.read(0, "battery/0/charge"), 1.0);
  world.step(100);
  EXPECT_NEAR(world.read(0, "battery/0/charge"), 1.0 - 2.0 / 10.0, 1e-6);
  EXPECT_NEAR(world.read(0, "battery/0/power"), 2.0, 1e-5);
}

// What it takes to get going is at least the kinetic energy, m v^2 / 2, over the efficiency.
TEST(Battery, GivesWhatTheTracksDoToTheirLoad) {
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

TEST(Battery, GivesWhatRotorsDoToTheAir) {
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
