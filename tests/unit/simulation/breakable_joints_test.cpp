// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "server/simulation/simulation.hpp"
#include "tests/support/worlds/small_world.hpp"

/// A weight that hangs from a beam by a breakable joint, and other things that are held.
namespace cohort {
namespace {

using namespace std::chrono_literals;
using namespace test;
using Eigen::Vector3d;

constexpr double mass = 2.0;
constexpr double gravity = 9.81;
constexpr double weight = mass * gravity;

class BreakableJoints : public ::testing::Test {
 protected:
  BreakableJoints() {
    description::World& world = experiment_.world;
    world = world_with_floor();
    world.gravity = {0, 0, -gravity};
    beam_ = place(world, static_shape("beam", description::Box{{1.0, 0.1, 0.1}}), "beam", at(0, 0, 1.0));
    box_ = place(world, box("box"), "box", at(0, 0, 0.7));
    experiment_.duration = 10s;
  }
  static description::Model box(const std::string& name) {
    return loose(name, description::Box{Vector3d::Constant(0.2)}, solid_box(mass, Vector3d::Constant(0.2)));
  }
  description::BreakableJoint& join(std::size_t first, std::size_t second, const Vector3d& p_L = Vector3d::Zero()) {
    description::BreakableJoint joint{"hook", first, 0, second, 0};
    joint.X_LP = Pose{p_L};
    experiment_.world.breakable_joints.push_back(joint);
    return experiment_.world.breakable_joints.back();
  }
  void push(std::size_t object, const Vector3d& force_W, const Vector3d& torque_W = Vector3d::Zero()) {
    experiment_.events.push_back({0ns, object, description::ApplyForce{0, force_W, torque_W, 10s}, "apply_force"});
  }
  // Returns true if it holds after half a second.
  bool holds_under_load() const {
    Simulation simulation(experiment_, 1);
    for (int i = 0; i < 50; ++i) simulation.step();
    return simulation.breakable_joints().holds(0);
  }

  description::Experiment experiment_;
  std::uint32_t beam_ = 0, box_ = 0;
};

TEST_F(BreakableJoints, BearAHangingWeightWithOppositeForcesAtBothEnds) {
  join(box_, beam_, {0, 0, 0.1});
  Simulation simulation(experiment_, 1);
  for (int i = 0; i < 100; ++i) simulation.step();
  EXPECT_LT((simulation.object_pose(box_).position - Vector3d(0, 0, 0.7)).norm(), 1e-4);
  const physics::Wrench on_box = simulation.breakable_joints().wrench_on_first(0);
  const physics::Wrench on_beam = simulation.breakable_joints().wrench_on_second(0);
  EXPECT_LT((on_box.force_W - Vector3d(0, 0, weight)).norm(), 1e-6 * weight);
  EXPECT_LT((on_beam.force_W + on_box.force_W).norm(), 1e-12);
  EXPECT_LT(on_box.torque_W.norm(), 1e-6);
}

TEST_F(BreakableJoints, BearTheTorqueOfAnOffsetWeight) {
  experiment_.world.physics.solver = description::Solver::direct;
  join(beam_, box_, {0.3, 0, -0.05});  // the static one first, and the joint 0.3 m aside of the box
  Simulation simulation(experiment_, 1);
  for (int i = 0; i < 100; ++i) simulation.step();
  const physics::Wrench on_beam = simulation.breakable_joints().wrench_on_first(0);
  const physics::Wrench on_box = simulation.breakable_joints().wrench_on_second(0);
  EXPECT_LT((on_beam.force_W - Vector3d(0, 0, -weight)).norm(), 1e-6 * weight);
  // The weight pulls at -0.3 m along x from the joint: r x F = (-0.3, 0, 0) x (0, 0, -W) = (0, -0.3 W, 0).
  EXPECT_LT((on_beam.torque_W - Vector3d(0, -0.3 * weight, 0)).norm(), 1e-3 * weight);
  EXPECT_LT((on_box.torque_W + on_beam.torque_W).norm(), 1e-3 * weight);
}

TEST_F(BreakableJoints, HoldJustBelowTheirForceAndBreakJustAboveIt) {
  join(box_, beam_).breaking_force = 1.001 * weight;
  EXPECT_TRUE(holds_under_load());
  experiment_.world.breakable_joints[0].breaking_force = 0.999 * weight;
  EXPECT_FALSE(holds_under_load());
}

TEST_F(BreakableJoints, HoldJustBelowTheirTorqueAndBreakJustAboveIt) {
  experiment_.world.physics.solver = description::Solver::direct;
  join(box_, beam_, {0.3, 0, 0}).breaking_torque = 1.01 * 0.3 * weight;
  EXPECT_TRUE(holds_under_load());
  experiment_.world.breakable_joints[0].breaking_torque = 0.99 * 0.3 * weight;
  EXPECT_FALSE(holds_under_load());
}

TEST_F(BreakableJoints, ReportWhatBrokeThemAndThenBearNothing) {
  join(box_, beam_).breaking_force = 30.0;
  experiment_.events.push_back(
      {100ms, box_, description::ApplyForce{0, {0, 0, -40.0}, Vector3d::Zero(), 10s}, "apply_force"});
  Simulation simulation(experiment_, 1);
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(simulation.breakable_joints().holds(0));
    simulation.step();
  }
  simulation.step();
  EXPECT_EQ(simulation.happened(), std::vector<std::string>{"joint 'hook' broke at 59.62 N"});
  EXPECT_FALSE(simulation.breakable_joints().holds(0));
  EXPECT_NEAR(simulation.breakable_joints().wrench_on_first(0).force_W.z(), weight + 40.0, 1e-3);
  simulation.step();
  EXPECT_TRUE(simulation.happened().empty());
  EXPECT_EQ(simulation.breakable_joints().wrench_on_first(0).force_W, Vector3d::Zero());
  for (int i = 0; i < 100; ++i) simulation.step();
  EXPECT_NEAR(simulation.object_pose(box_).position.z(), 0.1, 0.01) << "it lies on the floor";
}

TEST_F(BreakableJoints, ReportTheTorqueIfItBrokeThem) {
  join(box_, beam_).breaking_torque = 2.0;
  push(box_, Vector3d::Zero(), {0, 0, 5.0});
  Simulation simulation(experiment_, 1);
  simulation.step();
  EXPECT_EQ(simulation.happened(), std::vector<std::string>{"joint 'hook' broke at 5 N m"});
}

TEST_F(BreakableJoints, AreAtTheSecondLinkByDefault) {
  join(box_, beam_).X_LP.reset();
  push(box_, {3.0, 0, 0});
  Simulation simulation(experiment_, 1);
  for (int i = 0; i < 200; ++i) simulation.step();
  // About the origin of the beam, 0.3 m above the box.
  EXPECT_NEAR(simulation.breakable_joints().wrench_on_first(0).torque_W.y(), 0.3 * 3.0, 0.01);
}

// A physical pendulum about an edge, from horizontal: the speed at any angle is that of its energy.
TEST_F(BreakableJoints, OfTypeRevoluteAreHingesAtAnyAngle) {
  for (const bool is_static_first : {false, true}) {
    experiment_.world.breakable_joints.clear();
    description::BreakableJoint& hinge =
        is_static_first ? join(beam_, box_, {0.3, 0, -0.3}) : join(box_, beam_, {0.3, 0, 0});
    hinge.type = description::JointType::revolute;
    hinge.axis_P = Vector3d::UnitY();
    Simulation simulation(experiment_, 1);
    const double about_hinge = mass * 0.2 * 0.2 / 6.0 + mass * 0.09;
    double lowest = 0.0;
    for (int i = 0; i < 300; ++i) {
      simulation.step();
      const Vector3d arm = simulation.object_pose(box_).position - Vector3d(0.3, 0, 0.7);
      const double height = arm.z();
      EXPECT_NEAR(arm.norm(), 0.3, 5e-3) << "steps of 10 ms";
      EXPECT_NEAR(arm.y(), 0.0, 1e-6);
      const double speed = simulation.world().link_twist(BodyId{box_}, LinkId{0}).angular_W.norm();
      EXPECT_NEAR(0.5 * about_hinge * speed * speed, -mass * gravity * height, 0.1 * mass * gravity * 0.3);
      lowest = std::min(lowest, height);
    }
    EXPECT_LT(lowest, -0.295) << "it has swung through";
  }
}

TEST_F(BreakableJoints, OfTypeBallSwingBothWaysAndAreDamped) {
  description::BreakableJoint& ball = join(box_, beam_, {0.2, 0.2, 0});
  ball.type = description::JointType::ball;
  ball.damping = 0.5;
  Simulation simulation(experiment_, 1);
  for (int i = 0; i < 1000; ++i) simulation.step();
  const Vector3d arm = simulation.object_pose(box_).position - Vector3d(0.2, 0.2, 0.7);
  EXPECT_LT((arm - Vector3d(0, 0, -std::sqrt(0.08))).norm(), 0.01);
  EXPECT_LT(simulation.world().link_twist(BodyId{box_}, LinkId{0}).angular_W.norm(), 0.01);
}

TEST_F(BreakableJoints, HoldTwoMovingObjectsTogether) {
  const std::uint32_t other = place(experiment_.world, box("other"), "other", at(0.5, 0, 0.7));
  experiment_.world.gravity.setZero();
  join(box_, other, {0.25, 0, 0});
  push(box_, {4.0, 0, 0});
  Simulation simulation(experiment_, 1);
  for (int i = 0; i < 50; ++i) simulation.step();
  EXPECT_NEAR(simulation.world().link_twist(BodyId{other}, LinkId{0}).linear_W.x(), 4.0 / (2.0 * mass) * 0.5, 1e-3);
  // Half of the force accelerates the other one.
  EXPECT_NEAR(simulation.breakable_joints().wrench_on_second(0).force_W.x(), 2.0, 1e-3);
}

class ReleasedJoints : public BreakableJoints, public ::testing::WithParamInterface<std::pair<bool, bool>> {};

TEST_P(ReleasedJoints, StayReleasedAfterTheirObjectWasRemovedOrMoved) {
  const auto [is_static, is_moved] = GetParam();
  const std::uint32_t object = is_static ? beam_ : box_;
  join(box_, beam_);
  if (!is_moved)
    for (const bool is_present : {false, true})
      experiment_.events.push_back({2 * experiment_.world.step, object, description::SetPresence{is_present}, "set"});
  Simulation simulation(experiment_, 1);
  simulation.step();
  ASSERT_TRUE(simulation.breakable_joints().holds(0));
  if (is_moved)
    simulation.act(SetPose{simulation.objects().name(object), at(0, 2, 1.0)});
  else
    simulation.step();
  EXPECT_FALSE(simulation.breakable_joints().holds(0));
  for (int i = 0; i < 100; ++i) simulation.step();
  EXPECT_LT(simulation.object_pose(box_).position.z(), 0.2);
  EXPECT_TRUE(simulation.happened().empty());
}

INSTANTIATE_TEST_SUITE_P(Ends, ReleasedJoints,
                         ::testing::Values(std::pair{false, false}, std::pair{true, false}, std::pair{false, true},
                                           std::pair{true, true}));

TEST_F(BreakableJoints, HoldInAPlanarWorld) {
  experiment_.world.physics.fidelity = description::Fidelity::planar;
  experiment_.world.instances[box_].X_WM = at(0, 0, 0.1);
  experiment_.world.instances[beam_].X_WM = at(0, 1, 1.0);
  join(beam_, box_, {0, -1, 0}).breaking_force = 25.0;
  push(box_, {15.0, 0, 0});
  experiment_.events.push_back(
      {200ms, box_, description::ApplyForce{0, {60.0, 0, 0}, Vector3d::Zero(), 10s}, "apply_force"});
  Simulation simulation(experiment_, 1);
  for (int i = 0; i < 20; ++i) simulation.step();
  EXPECT_TRUE(simulation.breakable_joints().holds(0));
  EXPECT_LT((simulation.object_pose(box_).position - Vector3d(0, 0, 0.1)).norm(), 1e-3);
  // The ground holds with all the friction that it has, at the most the weight; here it does not have to.
  EXPECT_LE(std::abs(simulation.breakable_joints().wrench_on_second(0).force_W.x()), 15.0 + 1e-9);
  EXPECT_LT((simulation.breakable_joints().wrench_on_second(0).force_W +
             simulation.breakable_joints().wrench_on_first(0).force_W)
                .norm(),
            1e-12);
  simulation.step();
  EXPECT_FALSE(simulation.breakable_joints().holds(0));
  for (int i = 0; i < 20; ++i) simulation.step();
  EXPECT_GT(simulation.object_pose(box_).position.x(), 0.1);
}

TEST_F(BreakableJoints, GiveTheSameBitsForAnyThreadCountAndFromAnySnapshot) {
  const std::uint32_t other = place(experiment_.world, box("other"), "other", at(0.5, 0, 0.7));
  join(box_, beam_, {0.02, 0, 0.1}).breaking_force = 60.0;
  join(other, box_, {-0.25, 0, 0}).breaking_torque = 20.0;
  experiment_.events.push_back(
      {150ms, other, description::ApplyForce{0, {0, 0, -60.0}, Vector3d::Zero(), 100ms}, "apply_force"});
  Simulation straight(experiment_, 1);
  Simulation threads(experiment_, 4);
  bool has_broken = false;
  for (int tick = 0; tick < 40; ++tick) {
    Simulation restored(experiment_, 1);
    restored.restore(straight.save());
    ASSERT_EQ(restored.state_hash(), straight.state_hash()) << "tick " << tick;
    EXPECT_EQ(restored.save(), straight.save());
    for (Simulation* each : {&straight, &threads, &restored}) each->step();
    ASSERT_EQ(restored.state_hash(), straight.state_hash()) << "saved at tick " << tick;
    ASSERT_EQ(threads.state_hash(), straight.state_hash()) << "tick " << tick;
    EXPECT_EQ(restored.happened(), straight.happened());
    has_broken = has_broken || !straight.happened().empty();
  }
  EXPECT_TRUE(has_broken);
}

TEST_F(BreakableJoints, ChangeTheStateHashWhenReleased) {
  join(box_, beam_);
  Simulation simulation(experiment_, 1);
  const std::uint64_t before = simulation.state_hash();
  simulation.act(SetPose{simulation.objects().name(beam_), experiment_.world.instances[beam_].X_WM});
  EXPECT_NE(simulation.state_hash(), before);
}

}  // namespace
}  // namespace cohort
