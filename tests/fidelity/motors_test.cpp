// SPDX-License-Identifier: Apache-2.0

// Motors with position and effort commands.

#include <gtest/gtest.h>

#include "tests/support/worlds/small_world.hpp"

namespace cohort::test {
namespace {

using description::Joint;
using description::JointType;
using Eigen::Vector3d;

constexpr double moved_mass = 0.4;
constexpr double lever = 0.2;  // from the hinge to the centre of mass

// Returns a mass on a hinge about y, or on a rail along x, driven by a motor.
description::Model driven(JointType type, double max_velocity, double max_effort) {
  description::Model model;
  model.name = "driven";
  description::Inertial inertial = solid_box(moved_mass, {0.02, 0.02, 0.02});
  if (type == JointType::revolute) inertial.X_LI.position.x() = lever;
  model.links.push_back({"arm", {}, inertial, {}});
  Joint joint;
  joint.name = "joint";
  joint.type = type;
  joint.parent = Joint::world;
  joint.child = 0;
  joint.axis.direction = type == JointType::revolute ? Vector3d::UnitY() : Vector3d::UnitX();
  model.joints.push_back(joint);
  model.devices.push_back(description::VelocityMotor{"motor", 0, max_velocity, max_effort});
  return model;
}

TEST(Motors, MoveToAPositionWithinTheirVelocityLimit) {
  SmallWorld small(empty_world());
  const auto body = small.add(driven(JointType::prismatic, 0.5, 100.0), at(0, 0, 0));
  physics::World& world = small.world();
  world.set_joint_target(body, JointId{0}, physics::JointTarget::position(0.123));
  for (int i = 0; i < 100; ++i) {
    world.step();
    ASSERT_LE(world.joint_state(body, JointId{0}).velocity, 0.5 + 1e-9);
    ASSERT_LE(world.joint_state(body, JointId{0}).position, 0.123 + 1e-6) << "at step " << i;
  }
  EXPECT_NEAR(world.joint_state(body, JointId{0}).position, 0.123, 1e-6);
  EXPECT_NEAR(world.joint_state(body, JointId{0}).velocity, 0.0, 1e-6);
  world.set_joint_target(body, JointId{0}, physics::JointTarget::position(-0.1));
  small.run(1.0);
  EXPECT_NEAR(world.joint_state(body, JointId{0}).position, -0.1, 1e-6);
}

TEST(Motors, WithLittleEffortBrakeInTimeForTheirPosition) {
  for (const auto step : {1, 10, 20}) {
    SmallWorld small(empty_world(std::chrono::milliseconds(step)));
    // 1 m/s^2 for acceleration and braking: it never reaches its greatest velocity.
    const auto body = small.add(driven(JointType::prismatic, 5.0, moved_mass * 1.0), at(0, 0, 0));
    physics::World& world = small.world();
    world.set_joint_target(body, JointId{0}, physics::JointTarget::position(1.0));
    double greatest = 0.0;
    double seconds = 0.0;
    while (std::abs(world.joint_state(body, JointId{0}).position - 1.0) > 1e-3 && seconds < 5.0) {
      world.step();
      seconds += 1e-3 * step;
      greatest = std::max(greatest, world.joint_state(body, JointId{0}).velocity);
      ASSERT_LE(world.joint_state(body, JointId{0}).position, 1.0 + 1e-9) << "after " << seconds << " s";
    }
    // It accelerates over half the way and brakes over the other: t = 2 sqrt(s / a), v = sqrt(s a).
    EXPECT_NEAR(seconds, 2.0, 0.1) << "steps of " << step << " ms";
    EXPECT_NEAR(greatest, 1.0, 0.03);
  }
}

TEST(Motors, HoldAnArmAgainstItsWeightWithoutSagging) {
  const double moment = moved_mass * g * lever;
  for (const double strength : {1.1, 10.0}) {
    SmallWorld small(empty_world());
    const auto body = small.add(driven(JointType::revolute, 2.0, strength * moment), at(0, 0, 0));
    physics::World& world = small.world();
    for (const double target : {0.0, -0.4, 0.3}) {  // horizontal, above and below
      world.set_joint_target(body, JointId{0}, physics::JointTarget::position(target));
      const double from = world.joint_state(body, JointId{0}).position;
      double beyond = 0.0;
      for (int i = 0; i < 400; ++i) {
        world.step();
        const double position = world.joint_state(body, JointId{0}).position;
        beyond = std::max(beyond, target > from ? position - target : target - position);
      }
      EXPECT_NEAR(world.joint_state(body, JointId{0}).position, target, 1e-6) << strength << " times what holds it";
      EXPECT_LT(beyond, 0.01) << strength << " times what holds it, to " << target;
      EXPECT_NEAR(world.joint_state(body, JointId{0}).effort, -moment * std::cos(target), 1e-6);
    }
  }
}

TEST(Motors, TooWeakForAPositionGiveTheirGreatestEffort) {
  SmallWorld small(empty_world());
  const auto body = small.add(driven(JointType::revolute, 2.0, 0.3), at(0, 0, 0));
  small.world().set_joint_target(body, JointId{0}, physics::JointTarget::position(0.0));
  small.run(0.1);
  EXPECT_GT(small.world().joint_state(body, JointId{0}).position, 0.01) << "it sinks";
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).effort, -0.3, 1e-9);
}

TEST(Motors, RespectJointLimits) {
  SmallWorld small(empty_world());
  description::Model model = driven(JointType::prismatic, 0.5, 10.0);
  model.joints[0].axis.upper = 0.2;
  const auto body = small.add(model, at(0, 0, 0));
  small.world().set_joint_target(body, JointId{0}, physics::JointTarget::position(1.0));
  small.run(2.0);
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).position, 0.2, 1e-6);
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).effort, 0.0, 1e-6) << "and do not push against them";
}

TEST(Motors, GiveTheCommandedEffortWithinTheirLimit) {
  SmallWorld small(empty_world());
  const auto body = small.add(driven(JointType::prismatic, 0.5, 2.0), at(0, 0, 0));
  physics::World& world = small.world();
  world.set_joint_target(body, JointId{0}, physics::JointTarget::effort(1.5));
  small.run(0.5);
  EXPECT_NEAR(world.joint_state(body, JointId{0}).velocity, 0.5 * 1.5 / moved_mass, 1e-9) << "a = F / m";
  EXPECT_NEAR(world.joint_state(body, JointId{0}).effort, 1.5, 1e-12);
  world.set_joint_target(body, JointId{0}, physics::JointTarget::effort(-7.0));
  const double before = world.joint_state(body, JointId{0}).velocity;
  small.run(0.1);
  EXPECT_NEAR(world.joint_state(body, JointId{0}).velocity - before, -0.1 * 2.0 / moved_mass, 1e-9);
  EXPECT_NEAR(world.joint_state(body, JointId{0}).effort, -2.0, 1e-12);
  world.set_joint_target(body, JointId{0}, physics::JointTarget::effort(0.0));
  const double rolling = world.joint_state(body, JointId{0}).velocity;
  small.run(0.1);
  EXPECT_NEAR(world.joint_state(body, JointId{0}).velocity, rolling, 1e-12) << "it runs freely";
  world.set_joint_target(body, JointId{0}, physics::JointTarget::velocity(0.0));
  small.run(3.0);
  EXPECT_NEAR(world.joint_state(body, JointId{0}).velocity, 0.0, 1e-9) << "told a velocity again, it brakes";
}

TEST(Motors, ApplyTheSameEffortWithEverySolver) {
  for (const description::Solver solver :
       {description::Solver::iterative, description::Solver::convex, description::Solver::direct}) {
    SmallWorld small;
    small.description.physics.solver = solver;
    const auto robot = small.add(tracked_robot(), at(0, 0, 0));
    small.world().set_joint_target(robot, JointId{0}, physics::JointTarget::effort(1e-4));
    small.run(0.2);
    // The turret turns against the standing chassis: its own moment of inertia about z counts.
    EXPECT_NEAR(small.world().joint_state(robot, JointId{0}).velocity, 0.2 * 1e-4 / (0.3 * 0.058 * 0.058 / 2.0), 1e-3);
  }
}

TEST(Motors, InThePlaneMoveToPositionsButNotByEfforts) {
  SmallWorld small;
  small.description.physics.fidelity = description::Fidelity::planar;
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  small.world().set_joint_target(robot, JointId{0}, physics::JointTarget::position(0.5));
  small.run(0.2);
  EXPECT_NEAR(small.world().joint_state(robot, JointId{0}).position, 0.2 * 1.5, 1e-9) << "as fast as it may";
  small.run(1.0);
  EXPECT_NEAR(small.world().joint_state(robot, JointId{0}).position, 0.5, 1e-12);
  small.world().set_joint_target(robot, JointId{0}, physics::JointTarget::effort(0.1));
  small.run(0.2);
  EXPECT_NEAR(small.world().joint_state(robot, JointId{0}).position, 0.5, 1e-12);
}

TEST(Motors, SaveAndHashTheirCommands) {
  for (const description::Fidelity fidelity : {description::Fidelity::treel, description::Fidelity::planar}) {
    SmallWorld small;
    small.description.physics.fidelity = fidelity;
    const auto robot = small.add(tracked_robot(), at(0, 0, 0));
    small.world().set_joint_target(robot, JointId{0}, physics::JointTarget::velocity(0.3));
    const auto velocity = hash_of(small.world());
    small.world().set_joint_target(robot, JointId{0}, physics::JointTarget::effort(0.3));
    const auto effort = hash_of(small.world());
    small.world().set_joint_target(robot, JointId{0}, physics::JointTarget::position(0.3));
    const auto position = hash_of(small.world());
    EXPECT_NE(velocity, position);
    EXPECT_NE(velocity, effort);
    EXPECT_NE(position, effort);
    small.run(0.05);
    WorkerPool workers(1);
    const std::unique_ptr<physics::World> restored = physics::make_world(small.description, workers);
    restore_from(small.world(), *restored);
    for (int i = 0; i < 50; ++i) {
      restored->step();
      small.world().step();
      ASSERT_EQ(hash_of(*restored), hash_of(small.world())) << "at step " << i;
    }
    EXPECT_NEAR(restored->joint_state(robot, JointId{0}).position, 0.3, 1e-6);
  }
}

}  // namespace
}  // namespace cohort::test
