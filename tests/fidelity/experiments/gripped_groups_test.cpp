// SPDX-License-Identifier: Apache-2.0

// Groups of connected robots, and the rotor inertia of motors.

#include <gtest/gtest.h>

#include "tests/support/worlds/gripped_swarm.hpp"

namespace cohort::test {
namespace {

using description::Solver;

TEST(Motors, AddTheInertiaOfTheirRotor) {
  constexpr double rotor_inertia = 0.003;
  constexpr double torque = 0.02;
  SmallWorld small(empty_world());
  small.description.gravity.setZero();
  description::Model model = loose("wheel", description::Sphere{0.05}, solid_sphere(0.5, 0.05));
  model.joints.push_back({});
  model.joints[0].name = "axle";
  model.joints[0].type = description::JointType::revolute;
  model.joints[0].parent = description::Joint::world;
  model.devices.push_back(description::EffortMotor{"motor", 0, 1.0, rotor_inertia});
  const auto wheel = small.add(model, at(0, 0, 0));
  small.world().set_joint_target(wheel, JointId{0}, physics::JointTarget::effort(torque));
  small.run(1.0);
  const double inertia = 0.4 * 0.5 * 0.05 * 0.05;
  EXPECT_NEAR(small.world().joint_state(wheel, JointId{0}).velocity, torque / (inertia + rotor_inertia), 1e-9);
  EXPECT_NEAR(small.world().joint_state(wheel, JointId{0}).effort, torque, 1e-12);
}

struct Outcome {
  double gap = 0.0;
  double speed = 0.0;
  double height = 0.0;
};
// The default solver takes minutes for all seeds.
Solver solver_for(std::uint64_t seed) { return seed == 1 ? Solver::convex : Solver::iterative; }

Outcome drive(GrippedSwarm& swarm, int seconds) {
  Outcome worst;
  for (int tick = 0; tick < 100 * seconds; ++tick) {
    swarm.drive(tick);
    swarm.small.world().step();
    worst.gap = std::max(worst.gap, swarm.gap());
    worst.speed = std::max(worst.speed, swarm.greatest_speed());
    worst.height = std::max(worst.height, swarm.greatest_height());
  }
  return worst;
}

TEST(GrippedGroups, StayTogetherByTheirTurrets) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    GrippedSwarm swarm(solver_for(seed), seed, false);
    const Outcome worst = drive(swarm, 60);
    EXPECT_LT(worst.gap, 3e-3) << seed;
    EXPECT_LT(worst.speed, 0.5) << seed;
  }
}

TEST(GrippedGroups, GainNoEnergyWhenArmsLiftEachOther) {
  for (const double rotor_inertia : {0.0, 0.002}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      GrippedSwarm swarm(solver_for(seed), seed, true, rotor_inertia);
      const Outcome worst = drive(swarm, 30);
      EXPECT_LT(worst.gap, rotor_inertia > 0.0 ? 12e-3 : 25e-3) << seed;
      EXPECT_LT(worst.speed, 2.0) << seed;
      EXPECT_LT(worst.height, 0.1) << seed;
    }
  }
}

}  // namespace
}  // namespace cohort::test
