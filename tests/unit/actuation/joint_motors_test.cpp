// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/worlds/sensing_world.hpp"

/// Motors on joints as devices: what they are told, and what encoders and torque sensors say of it.
namespace cohort {
namespace {

using namespace test;

constexpr double turret_inertia = 0.3 * 0.058 * 0.058 / 2.0;  // about its axis [kg m^2]

// The robot with tracks, another motor on its turret.
description::Model robot_with(const description::Device& motor) {
  description::Model model = tracked_robot();
  model.devices[1] = motor;
  model.devices.push_back(description::TorqueSensor{"torque", 0});
  return model;
}

TEST(PositionMotors, TakeTheirJointToAPositionAndHoldItThere) {
  SensingWorld world;
  world.add(robot_with(description::PositionMotor{"turret", 0, 1.0, 0.3}), "robot", at(0, 0, 0));
  world.command(0, "turret/0/position", {0.8});
  world.step(50);
  EXPECT_NEAR(world.read(0, "turret/0/velocity"), 1.0, 0.01) << "no faster than it may";
  double farthest = 0.0;
  for (int i = 0; i < 150; ++i) {
    world.step();
    farthest = std::max(farthest, world.read(0, "turret/0/position"));
  }
  EXPECT_NEAR(world.read(0, "turret/0/position"), 0.8, 1e-3);
  EXPECT_LT(farthest, 0.801) << "without overshoot";
  EXPECT_NEAR(world.read(0, "torque/0/torque"), 0.0, 1e-4) << "nothing pulls at it";
}

TEST(EffortMotors, GiveTheTorqueThatTheyAreTold) {
  // The rotor of the motor turns with the turret.
  for (const double rotor : {0.0, 1e-3}) {
    SensingWorld world;
    world.add(robot_with(description::EffortMotor{"turret", 0, 0.1, rotor}), "robot", at(0, 0, 0));
    constexpr double torque = 2e-3;
    world.command(0, "turret/0/effort", {torque});
    world.step(20);
    EXPECT_NEAR(world.read(0, "torque/0/torque"), torque, 1e-6);
    const double velocity = torque / (turret_inertia + rotor) * 0.2;
    EXPECT_NEAR(world.read(0, "turret/0/velocity"), velocity, 0.02 * velocity) << rotor;
  }
}

TEST(EffortMotors, GiveNoMoreThanTheirGreatest) {
  SensingWorld world;
  world.add(robot_with(description::EffortMotor{"turret", 0, 0.1}), "robot", at(0, 0, 0));
  const auto fault = world.simulation().check_command(0, std::vector<double>{0.0, 0.0, 0.11});
  ASSERT_TRUE(fault.has_value());
  EXPECT_EQ(fault->reason, CommandFault::Reason::out_of_range);
  EXPECT_EQ(fault->channel, "turret/0/effort");
}

}  // namespace
}  // namespace cohort
