// SPDX-License-Identifier: Apache-2.0

// Compliant connections, connections that lift, and many at once.

#include <gtest/gtest.h>

#include "tests/support/worlds/gripped_swarm.hpp"

namespace cohort::test {
namespace {

using Eigen::Vector3d;
using physics::ConnectionGive;
using physics::Wrench;

// A box of 0.5 kg, connected to the world at its middle, without gravity.
struct HeldBox {
  static constexpr double mass = 0.5;
  static constexpr double size = 0.1;
  static constexpr double inertia = mass * size * size / 6.0;
  SmallWorld small{empty_world()};
  BodyId box;
  ConnectionId connection;

  explicit HeldBox(const ConnectionGive& give, const physics::ConnectionLimits& limits = {}) {
    small.description.gravity.setZero();
    const auto wall = small.add(static_shape("wall", description::Box{{0.1, 0.1, 0.1}}), at(0, 0, -5));
    box =
        small.add(loose("box", description::Box{{size, size, size}}, solid_box(mass, {size, size, size})), at(0, 0, 0));
    connection = small.world().connections().connect({box, LinkId{0}}, {}, {wall, LinkId{0}}, limits);
    small.world().connections().set_give(connection, give);
  }
  void push(const Vector3d& force, const Vector3d& torque, double seconds) {
    for (int i = 0; i < std::lround(seconds / 0.01); ++i) {
      small.world().push_body(box, LinkId{0}, {force, torque});
      small.world().step();
    }
  }
  double angle() {
    const Eigen::Quaterniond q = small.world().link_pose(box, LinkId{0}).orientation;
    return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
  }
};

// A box of 0.5 kg is held at 0.5 m from a hub that turns at 10 rad/s. A straight step of 10 ms leads 2.5 mm out of its
// circle.
TEST(Connections, HoldWhatTurnsFastOnItsCircle) {
  for (const double sense : {1.0, -1.0}) {
    description::World world = empty_world();
    world.gravity.setZero();
    SmallWorld small(world);
    description::Model hub;
    hub.name = "hub";
    hub.links.push_back({"hub", {}, solid_box(1.0, {0.1, 0.1, 0.1}), {}});
    hub.joints = {joint_of("axle", description::JointType::revolute, description::Joint::world, 0, Vector3d::UnitZ())};
    const auto turning = small.add(hub, at(0, 0, 1));
    const auto box =
        small.add(loose("box", description::Box{{0.1, 0.1, 0.1}}, solid_box(0.5, {0.1, 0.1, 0.1})), at(0.5, 0, 1));
    small.world().set_joint_state(turning, JointId{0}, std::array{0.0}, std::array{sense * 10.0});
    small.world().set_root_twist(box, {{0, 0, sense * 10.0}, {0, sense * 5.0, 0}});
    small.world().connections().connect({box, LinkId{0}}, Pose{}, {turning, LinkId{0}}, {});
    for (int tick = 0; tick < 1000; ++tick) {
      small.world().step();
      const Vector3d held = small.world().link_pose(turning, LinkId{0}).inverse() * small.position(box);
      ASSERT_LT((held - Vector3d(0.5, 0, 0)).norm(), 2e-5) << tick;
    }
    EXPECT_NEAR(small.velocity(box).norm(), 5.0, 0.01);
  }
}

TEST(Compliance, ASpringDeflectsByForceOverStiffness) {
  ConnectionGive give;
  give.linear_stiffness = 200.0;
  give.linear_damping = 10.0;
  give.angular_stiffness = Vector3d(2.0, 5.0, ConnectionGive::rigid);
  give.angular_damping = Vector3d(0.02, 0.02, 0.0);
  HeldBox held(give);
  held.push({1.0, 0, 0}, {0, 0.1, 0}, 3.0);
  EXPECT_NEAR(held.small.position(held.box).x(), 1.0 / 200.0, 1e-6);
  EXPECT_NEAR(held.angle(), 0.1 / 5.0, 1e-5);
  const Wrench wrench = held.small.world().connections().wrench(held.connection);
  EXPECT_NEAR(wrench.force_W.x(), -1.0, 1e-4);
  EXPECT_NEAR(wrench.torque_W.y(), -0.1, 1e-4);
  held.push(Vector3d::Zero(), {0, 0, 0.1}, 3.0);
  EXPECT_NEAR(held.angle(), 0.0, 1e-5) << "it came back, and is rigid about z";
}

TEST(Compliance, ASpringOscillatesAtItsFrequencyAndDamping) {
  ConnectionGive give;
  give.linear_stiffness = 20.0;  // 1 s for 0.5 kg
  HeldBox held(give);
  held.small.world().set_root_twist(held.box, {Vector3d::Zero(), {0.1, 0, 0}});
  int crossings = 0;
  double before = 0.0;
  double at_last = 0.0;
  double first = -1.0;
  for (int i = 1; i <= 500; ++i) {
    held.small.world().step();
    const double x = held.small.position(held.box).x();
    if (before < 0.0 && x >= 0.0) {
      at_last = 0.01 * (i - x / (x - before));
      if (first < 0.0) first = at_last;
      ++crossings;
    }
    before = x;
  }
  ASSERT_GE(crossings, 3);
  EXPECT_NEAR((at_last - first) / (crossings - 1), 2.0 * M_PI * std::sqrt(0.5 / 20.0), 0.01);
}

TEST(Compliance, IsStableAtAnyStiffnessAndDamping) {
  for (const double stiffness : {1.0, 1e4, 1e8, 1e12}) {
    for (const double damping : {0.0, 1.0, 1e6}) {
      ConnectionGive give;
      give.linear_stiffness = stiffness;
      give.linear_damping = damping;
      give.angular_stiffness = Vector3d::Constant(stiffness);
      give.angular_damping = Vector3d::Constant(damping);
      HeldBox held(give);
      held.small.world().set_root_twist(held.box, {Vector3d(3, 2, 1), Vector3d(1, -1, 0.5)});
      double greatest = 0.0;
      for (int i = 0; i < 500; ++i) {
        held.small.world().step();
        greatest = std::max(greatest, held.small.velocity(held.box).norm());
      }
      EXPECT_LE(greatest, 1.5 + 1e-6) << stiffness << " N/m, " << damping << " N s/m";
    }
  }
}

TEST(Compliance, SlipsAboveItsHoldingForceAndStays) {
  ConnectionGive give;
  give.holding_force = 2.0;
  HeldBox held(give);
  held.push({1.5, 0, 0}, Vector3d::Zero(), 1.0);
  EXPECT_NEAR(held.small.position(held.box).x(), 0.0, 1e-6) << "less than it holds";
  held.push({3.0, 0, 0}, Vector3d::Zero(), 0.2);
  // (3 - 2) N on 0.5 kg for 0.2 s; then 2 N brake it: 40 mm and 20 mm.
  EXPECT_NEAR(held.small.velocity(held.box).x(), 0.4, 1e-6);
  EXPECT_NEAR(held.small.world().connections().wrench(held.connection).force_W.x(), -2.0, 1e-6);
  held.small.run(1.0);
  EXPECT_NEAR(held.small.position(held.box).x(), 0.04 + 0.02, 3e-3);
  EXPECT_NEAR(held.small.velocity(held.box).x(), 0.0, 1e-9);
}

TEST(Compliance, TurnsFreelyOnlyAboutAnAxisWithoutHoldingTorque) {
  ConnectionGive give;
  give.holding_torque.z() = 0.0;
  HeldBox held(give);
  held.push(Vector3d::Zero(), {0.01, 0, 0.01}, 0.5);
  EXPECT_NEAR(held.small.world().link_twist(held.box, LinkId{0}).angular_W.z(), 0.5 * 0.01 / HeldBox::inertia, 1e-3);
  EXPECT_NEAR(held.small.world().link_twist(held.box, LinkId{0}).angular_W.x(), 0.0, 1e-6);
  EXPECT_GT(held.angle(), 1.0);
  held.small.world().connections().set_give(held.connection, {});
  held.small.run(0.1);
  const double angle = held.angle();
  held.small.run(1.0);
  EXPECT_NEAR(held.angle(), angle, 1e-6) << "closed again it holds it as it is now";
}

TEST(Compliance, IsSavedAndRestored) {
  ConnectionGive give;
  give.linear_stiffness = 50.0;
  give.holding_force = 2.0;
  give.holding_torque.z() = 0.01;
  HeldBox held(give);
  held.push({3.0, 0, 0}, {0, 0, 0.02}, 0.1);
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> restored = physics::make_world(held.small.description, workers);
  restore_from(held.small.world(), *restored);
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(hash_of(*restored), hash_of(held.small.world())) << "at step " << i;
    restored->step();
    held.small.world().step();
  }
}

TEST(Connections, BothEndsReportTheSameWrenchInTheirFrames) {
  HeldBox held({});
  held.push({1.0, 2.0, 3.0}, {0.1, 0.2, 0.3}, 0.5);
  const Wrench on_a = held.small.world().connections().wrench(held.connection);
  const Wrench on_b = held.small.world().connections().wrench(held.connection, physics::ConnectionEnd::b);
  EXPECT_LT((on_a.force_W + Vector3d(1, 2, 3)).norm(), 1e-4);
  EXPECT_LT((on_b.force_W - Vector3d(1, 2, 3)).norm(), 1e-4);
  EXPECT_LT((on_a.torque_W + Vector3d(0.1, 0.2, 0.3)).norm(), 1e-4);
  EXPECT_LT((on_a.torque_W + on_b.torque_W).norm(), 1e-5);
}

TEST(Connections, ReportTheBreakingWrenchForOneStep) {
  HeldBox held({}, {.force = 2.0});
  held.push({3.0, 0, 0}, Vector3d::Zero(), 0.01);
  ASSERT_EQ(held.small.world().connections().broken().size(), 1u);
  EXPECT_NEAR(held.small.world().connections().wrench(held.connection).force_W.x(), -3.0, 1e-3);
  EXPECT_NEAR(held.small.world().connections().wrench(held.connection, physics::ConnectionEnd::b).force_W.x(), 3.0,
              1e-3);
  held.small.world().step();
  EXPECT_EQ(held.small.world().connections().wrench(held.connection).force_W, Vector3d::Zero());
}

// 0.7 kg at the end of an arm of 10 cm that weighs 50 g, at ten iterations.
TEST(Lifting, AnArmLiftsARobotAndDoesNotSag) {
  SmallWorld small;
  const auto lifter = small.add(with_arm(), at(0, 0, 0));
  const auto lifted = small.add(tracked_robot(), at(0.03 + arm_length + 0.058, 0, 0));
  physics::World& world = small.world();
  world.connections().connect({lifter, LinkId{0}}, {}, {BodyId{0}, LinkId{0}});
  const auto grip = world.connections().connect({lifter, LinkId{arm_link}}, {{arm_length, 0, 0}}, {lifted, LinkId{1}});
  world.set_joint_target(lifter, JointId{elevation_joint}, physics::JointTarget::position(-0.5));
  double gap = 0.0;
  for (int i = 0; i < 300; ++i) {
    world.step();
    const Vector3d jaw = world.link_pose(lifter, LinkId{arm_link}) * Vector3d(arm_length, 0, 0);
    gap = std::max(gap, (jaw - world.link_pose(lifted, LinkId{1}) * Vector3d(-0.058, 0, 0.02)).norm());
  }
  EXPECT_LT(gap, 0.2e-3);
  EXPECT_NEAR(world.joint_state(lifter, JointId{elevation_joint}).position, -0.5, 1e-4);
  EXPECT_NEAR(-world.connections().wrench(grip).force_W.z(), 0.7 * g, 1e-3);
  // Both load the elevation joint: the arm at half its length, the robot with its centre of mass below the jaw.
  const double arm = 0.05 * g * 0.5 * arm_length * std::cos(0.5);
  const Vector3d joint = world.link_pose(lifter, LinkId{arm_link}).position;
  const Vector3d chassis = world.link_pose(lifted, LinkId{0}) * Vector3d(0, 0, 0.033);
  const Vector3d held = world.link_pose(lifted, LinkId{1}) * Vector3d(0, 0, 0.02);
  const double robot = g * (0.4 * (chassis - joint).x() + 0.3 * (held - joint).x());
  EXPECT_NEAR(world.joint_state(lifter, JointId{elevation_joint}).effort, -(arm + robot), 1e-3);
}

TEST(Lifting, ARobotHeldByTwoOthersLiftsAFourth) {
  SmallWorld small;
  const auto lifter = small.add(with_arm(), at(0, 0, 0));
  const auto second = small.add(tracked_robot(), at(-0.13, 0, 0));
  const auto third = small.add(tracked_robot(), at(-0.26, 0, 0));
  const auto lifted = small.add(tracked_robot(), at(0.03 + arm_length + 0.058, 0, 0));
  physics::World& world = small.world();
  world.connections().connect({lifter, LinkId{1}}, {{-0.065, 0, 0.02}}, {second, LinkId{1}});
  world.connections().connect({second, LinkId{1}}, {{-0.065, 0, 0.02}}, {third, LinkId{1}});
  world.connections().connect({lifter, LinkId{arm_link}}, {{arm_length, 0, 0}}, {lifted, LinkId{1}});
  world.set_joint_target(lifter, JointId{elevation_joint}, physics::JointTarget::position(-0.3));
  for (int i = 0; i < 300; ++i) world.step();
  EXPECT_NEAR(world.joint_state(lifter, JointId{elevation_joint}).position, -0.3, 1e-3);
  EXPECT_GT(small.position(lifted).z(), 0.02);
  EXPECT_LT(small.velocity(lifted).norm(), 1e-3);
  EXPECT_GT(small.up(lifter).z(), 0.99);
}

}  // namespace
}  // namespace cohort::test
