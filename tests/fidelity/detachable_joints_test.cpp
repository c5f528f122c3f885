// SPDX-License-Identifier: Apache-2.0

// Detachable joints: a robot holds objects until it is commanded to release them.

#include <gtest/gtest.h>

#include "tests/support/worlds/sensing_world.hpp"
#include "tests/support/worlds/small_world.hpp"

namespace cohort::test {
namespace {

using description::Dynamics;
using description::Fidelity;
using Eigen::Vector3d;

// A robot with a crate of 50 g in the air beside it, 0.2 m apart and attached to the robot's turret.
class DetachableJoints : public ::testing::TestWithParam<std::pair<Fidelity, Dynamics>> {
 protected:
  DetachableJoints() { put_together(world_); }
  void put_together(SensingWorld& world, bool is_initially_attached = true) {
    world.world().physics.fidelity = GetParam().first;
    world.world().physics.dynamics = GetParam().second;
    description::Model model = tracked_robot();
    description::DetachableJoint hook{"hook", turret, "crate"};
    hook.is_initially_attached = is_initially_attached;
    model.devices.push_back(hook);
    world.add(model, "robot", at(0, 0, 0));
    crate_ = world.add(loose("crate", description::Box{{0.04, 0.04, 0.04}}, solid_box(0.05, {0.04, 0.04, 0.04})),
                       "crate", at(0.2, 0, 0.1));
  }
  Pose pose_of_crate(SensingWorld& world) { return world.simulation().world().link_pose(BodyId{crate_}, LinkId{0}); }
  Vector3d crate() { return pose_of_crate(world_).position; }
  // Returns the position of the crate in the turret's frame.
  Vector3d held_at() {
    const BodyId body = world_.simulation().body_of(0);
    return world_.simulation().world().link_pose(body, LinkId{turret}).inverse() * crate();
  }
  void attach(double value) { world_.command(0, "hook/0/attached", {value}); }
  void drive(SensingWorld& world, double left, double right) {
    world.command(0, "treel/left/velocity", {left});
    world.command(0, "treel/right/velocity", {right});
  }

  SensingWorld world_;
  std::uint32_t crate_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Every, DetachableJoints,
                         ::testing::Values(std::pair(Fidelity::articulated, Dynamics::cohort),
                                           std::pair(Fidelity::articulated, Dynamics::bullet),
                                           std::pair(Fidelity::treel, Dynamics::cohort),
                                           std::pair(Fidelity::treel, Dynamics::bullet)));

TEST_P(DetachableJoints, HoldFromTheStartWithoutACommand) {
  const Vector3d before = held_at();
  world_.step(100);
  EXPECT_LT((held_at() - before).norm(), 1e-3) << held_at().transpose();
  EXPECT_NEAR(crate().z(), 0.1, 2e-3);
}

TEST_P(DetachableJoints, HoldNothingUntilACommandIfTheyAreInitiallyDetached) {
  SensingWorld world;
  put_together(world, false);
  world.step(5);
  const Vector3d before = pose_of_crate(world).position;
  EXPECT_NEAR(before.z(), 0.1 - 0.5 * g * 0.05 * 0.05, 0.003) << "it falls freely";
  world.command(0, "hook/0/attached", {1.0});
  world.step(100);
  EXPECT_LT((pose_of_crate(world).position - before).norm(), 3e-3) << pose_of_crate(world).position.transpose();
}

TEST_P(DetachableJoints, ReleaseAndAttachAgainInTheNewRelativePose) {
  attach(1.0);
  world_.step(20);
  attach(0.5);
  world_.step(5);
  EXPECT_NEAR(crate().z(), 0.1 - 0.5 * g * 0.05 * 0.05, 0.003) << "it falls freely";
  world_.step(95);
  EXPECT_NEAR(crate().z(), 0.02, 1e-3);
  attach(0.6);
  world_.step();
  const Vector3d before = held_at();
  drive(world_, 0.1, 0.05);
  world_.step(200);
  EXPECT_LT((held_at() - before).norm(), 2e-3);
  EXPECT_GT((crate() - Vector3d(0.2, 0, 0.02)).norm(), 0.05) << "it goes along";
}

TEST_P(DetachableJoints, AttachALostObjectAgainAfterARelease) {
  world_.step(10);
  world_.simulation().act(SetPose{"crate", at(0.3, 0, 0.3)});
  attach(1.0);
  world_.step(100);
  EXPECT_NEAR(crate().z(), 0.02, 1e-3) << "it was torn away and fell";
  attach(0.0);
  world_.step();
  attach(1.0);
  world_.step();
  const Vector3d before = held_at();
  drive(world_, -0.1, -0.1);
  world_.step(100);
  EXPECT_LT((held_at() - before).norm(), 2e-3);
}

TEST_P(DetachableJoints, AreTheSameForAnyThreadCountAndAfterRestore) {
  const auto hash_after = [&](SensingWorld& world, int ticks) {
    world.step(ticks);
    return world.simulation().state_hash();
  };
  SensingWorld other(3), restored(2);
  for (SensingWorld* each : {&other, &restored}) put_together(*each);
  for (SensingWorld* each : {&world_, &other}) {
    drive(*each, 0.1, 0.05);
    each->command(0, "hook/0/attached", {1.0});
  }
  ASSERT_EQ(hash_after(world_, 30), hash_after(other, 30));
  restored.simulation().restore(world_.simulation().save());
  ASSERT_EQ(restored.simulation().state_hash(), world_.simulation().state_hash());
  // The held object is part of the state: the restored robot can release it.
  for (const double value : {1.0, 0.0, 1.0}) {
    for (SensingWorld* each : {&world_, &other, &restored}) {
      drive(*each, 0.1, 0.05);
      each->command(0, "hook/0/attached", {value});
    }
    const std::uint64_t hash = hash_after(world_, 20);
    EXPECT_EQ(hash, hash_after(other, 20)) << value;
    EXPECT_EQ(hash, hash_after(restored, 20)) << value;
  }
}

TEST_P(DetachableJoints, HoldNothingWithoutTheirObject) {
  SensingWorld world;
  description::Model model = tracked_robot();
  model.devices.push_back(description::DetachableJoint{"hook", turret, "nobody"});
  world.add(model, "robot", at(0, 0, 0));
  world.command(0, "hook/0/attached", {1.0});
  world.step(10);
  EXPECT_LT(world.simulation().robot_pose(0).position.norm(), 0.01);
}

}  // namespace
}  // namespace cohort::test
