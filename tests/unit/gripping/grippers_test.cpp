// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/worlds/sensing_world.hpp"

/// Tests what grippers grasp, hold and lose.
namespace cohort {
namespace {

using namespace test;

constexpr double radius = 0.058;
constexpr double half_angle = 0.6;
constexpr double depth = 0.015;
constexpr int closing_ticks = 60;

// A robot with tracks whose turret has a gripper in front and a ring around it.
description::Model gripping_robot(double breaking_force = std::numeric_limits<double>::infinity()) {
  description::Model model = tracked_robot();
  description::Gripper gripper;
  gripper.name = "gripper";
  gripper.link = 1;
  gripper.X_LG.position = {radius, 0, 0.02};
  gripper.depth = depth;
  gripper.half_angle = half_angle;
  gripper.height = 0.01;
  gripper.breaking_force = breaking_force;
  model.devices.push_back(gripper);
  model.devices.push_back(description::TractionSensor{"traction", 0});
  model.devices.push_back(description::TorqueSensor{"turret_torque", 0});
  model.grip_rings.push_back({"ring", 1, {{0, 0, 0.02}}, radius});
  return model;
}

// Two robots, the second with its ring 8 mm before the jaw of the first, seen by the jaw at `aside`.
struct Pair {
  SensingWorld world;
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  std::size_t first_body = 0;
  std::size_t second_body = 0;

  explicit Pair(double aside = 0.0, double gap = 0.008, double yaw = 0.5,
                double breaking_force = std::numeric_limits<double>::infinity()) {
    const double distance = radius + gap;
    first_body = world.add(gripping_robot(breaking_force), "first", at(0, 0, 0));
    second_body = world.add(gripping_robot(), "second",
                            at(radius + distance * std::cos(aside), distance * std::sin(aside), 0, yaw));
    second = 1;
    open(first);
    open(second);
  }
  void open(std::uint32_t robot) { world.command(robot, "gripper/0/opening", {1.0}); }
  void close(std::uint32_t robot, double opening = 0.0) { world.command(robot, "gripper/0/opening", {opening}); }
  bool grips(std::uint32_t robot) { return world.read(robot, "gripper/0/gripping") == 1.0; }
  void drive(std::uint32_t robot, double left, double right) {
    world.command(robot, "treel/left/velocity", {left});
    world.command(robot, "treel/right/velocity", {right});
  }
  Pose second_in_first() {
    const physics::World& physics = world.simulation().world();
    return physics.link_pose(BodyId{first_body}, LinkId{1}).inverse() *
           physics.link_pose(BodyId{second_body}, LinkId{1});
  }
};

// The reading is the whole force. The grip also bears a part of the weight, which statics leaves open; level, it pulls.
void expect_pull(SensingWorld& world, double pull) {
  const Eigen::Vector3d force_W = world.simulation().world().connections().wrench(ConnectionId{0}).force_W;
  EXPECT_NEAR(world.read(0, "gripper/0/force"), force_W.norm(), 1e-9);
  EXPECT_NEAR(force_W.head<2>().norm(), pull, 0.001);
}

TEST(Grippers, GraspARingAtEveryAngleWithinTheirAcceptanceAndAtNoneOutside) {
  for (const double aside : {-0.59, -0.3, 0.0, 0.3, 0.59}) {
    Pair pair(aside);
    EXPECT_EQ(pair.world.read(0, "gripper/0/grippable"), 1.0) << aside;
    pair.close(0);
    pair.world.step(closing_ticks);
    EXPECT_TRUE(pair.grips(0)) << aside;
  }
  for (const double aside : {-0.63, 0.63}) {
    Pair pair(aside);
    EXPECT_EQ(pair.world.read(0, "gripper/0/grippable"), 0.0) << aside;
    pair.close(0);
    pair.world.step(closing_ticks);
    EXPECT_FALSE(pair.grips(0)) << aside;
  }
}

TEST(Grippers, GraspNothingBeyondTheirDepth) {
  Pair near(0.0, depth - 0.001);
  near.close(0);
  near.world.step(closing_ticks);
  EXPECT_TRUE(near.grips(0));
  Pair far(0.0, depth + 0.001);
  far.close(0);
  far.world.step(closing_ticks);
  EXPECT_FALSE(far.grips(0));
}

TEST(Grippers, TakeTheirTimeToCloseAndGraspPastHalf) {
  Pair pair;
  pair.close(0);
  pair.world.step(24);
  EXPECT_NEAR(pair.world.read(0, "gripper/0/opening"), 1.0 - 0.24 / 0.5, 1e-9);
  EXPECT_FALSE(pair.grips(0));
  pair.world.step(3);
  EXPECT_TRUE(pair.grips(0));
}

TEST(Grippers, HoldRigidlyAndLetGo) {
  Pair pair;
  pair.close(0);
  pair.world.step(closing_ticks);
  const Pose before = pair.second_in_first();
  pair.drive(0, -0.1, -0.1);
  pair.world.step(200);
  const Pose after = pair.second_in_first();
  EXPECT_LT((after.position - before.position).norm(), 0.5e-3);
  EXPECT_LT(after.orientation.angularDistance(before.orientation), 0.01);
  // The other one brakes: both motors of the first give all they can, a torque over the radius of a wheel.
  expect_pull(pair.world, 2.0 * 0.02 / 0.022);
  pair.open(0);
  pair.world.step(closing_ticks);
  EXPECT_FALSE(pair.grips(0));
  EXPECT_EQ(pair.world.read(0, "gripper/0/force"), 0.0);
  EXPECT_GT((pair.second_in_first().position - before.position).norm(), 0.01);
}

TEST(Grippers, ThatAreNotQuiteClosedGiveAboutTheAxisOfTheRing) {
  const auto turned_by = [](double opening) {
    Pair pair;
    pair.close(0, opening);
    pair.world.step(closing_ticks);
    const Pose before = pair.second_in_first();
    pair.world.command(1, "turret/0/velocity", {1.0});  // its chassis is held by the ground
    pair.world.step(100);
    const Pose after = pair.second_in_first();
    EXPECT_TRUE(pair.grips(0));
    return after.orientation.angularDistance(before.orientation);
  };
  EXPECT_LT(turned_by(0.0), 0.01);
  EXPECT_GT(turned_by(0.499), 0.1);
}

TEST(Grippers, CloseEmptyAndGraspWhatComes) {
  Pair pair(0.0, 0.05);
  pair.close(0);
  pair.world.step(closing_ticks);
  EXPECT_FALSE(pair.grips(0));
  EXPECT_EQ(pair.world.read(0, "gripper/0/opening"), 0.0);
  pair.drive(0, 0.1, 0.1);
  pair.world.step(80);
  EXPECT_TRUE(pair.grips(0));
}

TEST(Grippers, LoseWhatPullsHarderThanTheyBearAndGraspAgainOnlyOnceOpened) {
  Pair pair(0.0, 0.008, 0.5, 1.0);
  pair.close(0);
  pair.world.step(closing_ticks);
  ASSERT_TRUE(pair.grips(0));
  pair.drive(0, -0.1, -0.1);
  pair.world.step(5);
  EXPECT_FALSE(pair.grips(0));
  pair.drive(0, 0.0, 0.0);
  pair.world.step(20);
  EXPECT_FALSE(pair.grips(0)) << "though it is still closed";
}

TEST(Grippers, SlipAboveWhatTheyHold) {
  // The other one brakes with 1.8 N.
  const auto moved_apart = [](double holding_force) {
    SensingWorld world;
    description::Model weak = gripping_robot();
    for (description::Device& device : weak.devices)
      if (auto* const gripper = std::get_if<description::Gripper>(&device)) gripper->holding_force = holding_force;
    const std::uint32_t first = world.add(weak, "first", at(0, 0, 0));
    const std::uint32_t second = world.add(gripping_robot(), "second", at(2.0 * radius + 0.008, 0, 0, 0.5));
    world.command(1, "gripper/0/opening", {1.0});
    world.command(0, "gripper/0/opening", {0.0});
    world.step(closing_ticks);
    const auto apart = [&] {
      return (world.simulation().object_pose(first).position - world.simulation().object_pose(second).position).norm();
    };
    const double before = apart();
    world.command(0, "treel/left/velocity", {-0.1});
    world.command(0, "treel/right/velocity", {-0.1});
    world.step(100);
    EXPECT_EQ(world.read(0, "gripper/0/gripping"), 1.0);
    expect_pull(world, std::min(holding_force, 2.0 * 0.02 / 0.022));
    return apart() - before;
  };
  EXPECT_GT(moved_apart(0.5), 0.05);
  EXPECT_LT(moved_apart(60.0), 0.001);
}

TEST(Grippers, WithABeamSeeWhateverIsBetweenTheirSides) {
  description::Model model = gripping_robot();
  for (description::Device& device : model.devices)
    if (auto* const gripper = std::get_if<description::Gripper>(&device))
      gripper->light_barrier = description::Gripper::LightBarrier::beam;
  // A post that cannot be gripped; the beam is 7.5 mm before the jaw, from 15 mm left of it to 15 mm right.
  const auto sees = [&](double x, double y) {
    SensingWorld world;
    world.add(model, "robot", at(0, 0, 0));
    world.add(static_shape("post", description::Cylinder{0.004, 0.2}), "post", at(radius + x, y, 0.1));
    return world.read(0, "gripper/0/grippable") == 1.0;
  };
  EXPECT_TRUE(sees(0.0075, 0.0));
  EXPECT_TRUE(sees(0.0075, 0.014));
  EXPECT_FALSE(sees(0.0075, 0.03));
  EXPECT_FALSE(sees(0.014, 0.0));
}

TEST(Grippers, OfTwoRobotsMayHoldEachOther) {
  Pair pair(0.0, 0.008, std::numbers::pi);
  pair.close(0);
  pair.close(1);
  pair.world.step(closing_ticks);
  EXPECT_TRUE(pair.grips(0));
  EXPECT_TRUE(pair.grips(1));
}

TEST(Grippers, LetGoOfWhatLeavesTheWorld) {
  Pair pair;
  pair.close(0);
  pair.world.step(closing_ticks);
  ASSERT_TRUE(pair.grips(0));
  Simulation& simulation = pair.world.simulation();
  simulation.act(RemoveObject{simulation.objects().name(static_cast<std::uint32_t>(pair.second_body))});
  pair.world.step();
  EXPECT_FALSE(pair.grips(0));
}

TEST(Grippers, HoldOnToACollisionThatIsGrippableAndToNoOther) {
  for (const bool is_grippable : {true, false}) {
    SensingWorld world;
    world.add(gripping_robot(), "robot", at(0, 0, 0));
    description::Model box = static_shape("box", description::Box{{0.1, 0.3, 0.2}});
    box.links[0].collisions[0].surface.is_grippable = is_grippable;
    world.add(box, "box", at(radius + 0.05 + 0.01, 0, 0.1));
    world.command(0, "gripper/0/opening", {0.0});
    world.step(closing_ticks);
    EXPECT_EQ(world.read(0, "gripper/0/gripping"), is_grippable ? 1.0 : 0.0);
  }
}

TEST(Grippers, AreRestoredInTheMiddleOfAGraspWithAnyThreads) {
  Pair pair;
  pair.close(0, 0.3);
  pair.world.step(10);
  for (const int ticks : {5, 25}) {
    pair.world.step(ticks);
    const std::vector<std::byte> snapshot = pair.world.simulation().save();
    Simulation restored(pair.world.experiment, 4);
    restored.restore(snapshot);
    ASSERT_EQ(restored.state_hash(), pair.world.simulation().state_hash());
    for (int i = 0; i < 30; ++i) restored.step();
    pair.world.step(30);
    EXPECT_EQ(restored.state_hash(), pair.world.simulation().state_hash());
  }
}

TEST(TractionSensor, ReadsThePullOfWhatTheGripperHolds) {
  Pair pair;
  pair.close(0);
  pair.world.step(closing_ticks);
  pair.drive(0, -0.05, -0.05);
  pair.world.step(100);
  // At constant velocity the turret is drawn forwards by as much as the gripper holds.
  const double fx = pair.world.read(0, "traction/0/force", 0);
  EXPECT_GT(fx, 0.1);
  EXPECT_NEAR(pair.world.read(0, "traction/0/direction"), std::atan2(pair.world.read(0, "traction/0/force", 1), fx),
              1e-12);
  EXPECT_NEAR(pair.world.read(0, "traction/0/intensity"), pair.world.read(0, "gripper/0/force"), 0.1);
}

TEST(TorqueSensor, ReadsWhatTheMotorGives) {
  Pair pair(0.0, 0.1);
  pair.world.command(0, "turret/0/velocity", {1.0});
  pair.world.step();
  // From rest to 1 rad/s in a step would take 0.05 N m and more of a turret of 5e-4 kg m^2, if nothing else moved.
  EXPECT_NEAR(pair.world.read(0, "turret_torque/0/torque"), 5.046e-4 / 0.01, 1e-4);
  EXPECT_NEAR(pair.world.read(0, "turret_torque/0/torque"),
              pair.world.simulation().world().joint_state(BodyId{pair.first_body}, JointId{0}).effort, 1e-12);
}

}  // namespace
}  // namespace cohort
