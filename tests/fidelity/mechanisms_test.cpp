// SPDX-License-Identifier: Apache-2.0

// Joints beyond a tree of hinges: loops, joints that follow others, screws.

#include <gtest/gtest.h>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Joint;
using description::JointType;
using Eigen::Vector3d;

class Mechanisms : public EveryPhysics {
 protected:
  description::World space(double gravity = 0.0) const {
    description::World world = empty_world();
    world.physics = GetParam().world().physics;
    world.physics.lowest = -100.0;
    world.gravity = {0, 0, -gravity};
    return world;
  }
  // Returns a bar from its origin along `along`.
  static description::Link bar(const std::string& name, const Vector3d& place, const Vector3d& along) {
    const Vector3d size = Vector3d::Constant(0.02) + along.cwiseAbs();
    description::Link link{name, {place}, solid_box(0.5, size), {}};
    link.inertial.X_LI.position = 0.5 * along;
    link.collisions.push_back({"bar", {0.5 * along}, description::Box{size}, {}});
    return link;
  }
  // Returns two bars on the world, of which the second follows the first.
  static description::Model pair(JointType second, double multiplier, double offset) {
    description::Model model;
    model.name = "pair";
    model.links.push_back(bar("leader", {0, 0, 0}, {0.2, 0, 0}));
    model.links.push_back(bar("follower", {0, 1, 0}, {0.2, 0, 0}));
    model.joints = {joint_of("first", JointType::revolute, Joint::world, 0, Vector3d::UnitZ()),
                    joint_of("second", second, Joint::world, 1, Vector3d::UnitZ())};
    model.couplings = {{1, 0, multiplier, offset}};
    return model;
  }
};
INSTANTIATE_TEST_SUITE_P(Every, Mechanisms, ::testing::Values(treel, by_bullet(treel)), name_of);

// Two bars of 0.2 m stand 0.3 m apart with a coupler on top: the rocker turns by the same angle as the crank. Bars that
// a joint connects overlap there and do not collide, including at the loop joint.
TEST_P(Mechanisms, AFourBarLinkageMovesAsAParallelogram) {
  description::Model linkage;
  linkage.name = "linkage";
  linkage.self_collide = true;
  linkage.links.push_back(bar("crank", {0, 0, 0}, {0, 0, 0.2}));
  linkage.links.push_back(bar("coupler", {0, 0, 0.2}, {0.3, 0, 0}));
  linkage.links.push_back(bar("rocker", {0.3, 0, 0}, {0, 0, 0.2}));
  const Vector3d y = Vector3d::UnitY();
  linkage.joints = {joint_of("crank_joint", JointType::revolute, Joint::world, 0, y),
                    joint_of("elbow", JointType::revolute, 0, 1, y),
                    joint_of("rocker_joint", JointType::revolute, Joint::world, 2, y)};
  linkage.loop_joints = {joint_of("closing", JointType::revolute, 1, 2, y, {0, 0, 0.2})};
  linkage.devices.emplace_back(description::VelocityMotor{"motor", 0, 2.0, 20.0, 0.0});
  SmallWorld small(space(9.81));
  const auto body = small.add(linkage, at(0, 0, 1));
  small.world().set_joint_target(body, JointId{0}, physics::JointTarget::velocity(0.5));
  double widest = 0.0;
  double furthest_apart = 0.0;
  for (int tick = 0; tick < 200; ++tick) {  // by 1 rad
    small.world().step();
    const Pose X_WC = small.world().link_pose(body, LinkId{1});
    const Pose X_WR = small.world().link_pose(body, LinkId{2});
    widest = std::max(widest, (X_WC * Vector3d(0.3, 0, 0) - X_WR * Vector3d(0, 0, 0.2)).norm());
    furthest_apart = std::max(furthest_apart, std::abs(small.world().joint_state(body, JointId{0}).position -
                                                       small.world().joint_state(body, JointId{2}).position));
  }
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).position, 1.0, 0.01);
  EXPECT_LT(widest, 1e-4) << "the gap where the loop closes";
  EXPECT_LT(furthest_apart, 1e-3);
  EXPECT_NEAR(small.position(body, 1).y(), 0.0, 1e-6) << "it stays in its plane";
}

// Two cranks and two couplers of 0.3 m swing for 20 s. Their ends move on arcs, where they would part by h v^2 / 2r
// in each step. The error that is left falls with the third power of the step.
TEST_P(Mechanisms, AFiveBarLinkageThatSwingsStaysClosed) {
  constexpr double length = 0.3;
  const Vector3d y = Vector3d::UnitY();
  const auto rod = [&](const std::string& name, const Vector3d& from, const Vector3d& to) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), to - from);
    description::Link link{name, {from, turn}, solid_box(0.2, {length, 0.02, 0.02}), {}};
    link.inertial.X_LI.position = {0.5 * length, 0, 0};
    return link;
  };
  const auto linkage_that_leans = [&](double angle) {
    const Vector3d left{-0.15, 0, 0}, right{0.15, 0, 0};
    const Vector3d along = length * Vector3d(std::sin(angle), 0, -std::cos(angle));
    const Vector3d apex = along + Vector3d(0, 0, -std::sqrt(length * length - 0.15 * 0.15));
    description::Model linkage;
    linkage.name = "five_bar";
    linkage.links = {rod("left_crank", left, left + along), rod("left_coupler", left + along, apex),
                     rod("right_crank", right, right + along), rod("right_coupler", right + along, apex)};
    linkage.joints = {
        joint_of("a", JointType::revolute, Joint::world, 0, y), joint_of("b", JointType::revolute, 0, 1, y),
        joint_of("c", JointType::revolute, Joint::world, 2, y), joint_of("d", JointType::revolute, 2, 3, y)};
    linkage.loop_joints = {joint_of("e", JointType::revolute, 1, 3, y, {length, 0, 0})};
    return linkage;
  };
  for (const double angle : {0.4, -0.4, 1.0}) {
    for (const int milliseconds : {10, 5, 2, 1}) {
      description::World world = space(9.81);
      world.step = std::chrono::milliseconds(milliseconds);
      SmallWorld small(world);
      const auto body = small.add(linkage_that_leans(angle), at(0, 0, 1));
      const auto end_of = [&](std::size_t link) {
        return small.world().link_pose(body, LinkId{link}) * Vector3d(length, 0, 0);
      };
      double widest = 0.0;
      for (int tick = 0; tick < 20000 / milliseconds; ++tick) {
        small.world().step();
        widest = std::max(widest, (end_of(1) - end_of(3)).norm());
      }
      EXPECT_LT(widest, (angle == 1.0 ? 0.8e-3 : 0.15e-3) * std::pow(0.1 * milliseconds, 3))
          << angle << " rad, " << milliseconds << " ms";
    }
  }
}

// The second axis of a universal joint leads or follows a hinge; a torque about y turns both bars.
TEST_P(Mechanisms, TheSecondAxisOfAUniversalJointIsCoupledToo) {
  for (const bool follows : {true, false}) {
    description::Model model = pair(JointType::universal, follows ? -2.0 : -0.5, 0.1);
    model.joints[0].axis.direction = Vector3d::UnitY();
    model.joints[1].axis.direction = Vector3d::UnitX();
    model.joints[1].second_axis.direction = Vector3d::UnitY();
    model.couplings[0].moves_second_axis = follows;
    model.couplings[0].follows_second_axis = !follows;
    if (!follows) std::swap(model.couplings[0].follower, model.couplings[0].leader);
    SmallWorld small(space(0.0));
    const auto body = small.add(model, at(0, 0, 1));
    const auto angle = [&](std::size_t link) {
      const Vector3d along = small.world().link_pose(body, LinkId{link}).orientation * Vector3d::UnitX();
      EXPECT_NEAR(along.y(), 0.0, 1e-6) << "it stays in its plane";
      return std::atan2(-along.z(), along.x());
    };
    for (int tick = 0; tick < 100; ++tick) {
      small.world().push_body(body, LinkId{0}, {Vector3d::Zero(), Vector3d(0, 0.02, 0)});
      small.world().step();
    }
    EXPECT_GT(std::abs(angle(0)), 0.1);
    EXPECT_NEAR(angle(follows ? 1 : 0), follows ? 0.1 - 2.0 * angle(0) : 0.1 - 0.5 * angle(1), 1e-4);
  }
}

// A bar on a ball joint at one end; the loop joint at its other end leaves it no freedom, or that of a hinge.
TEST_P(Mechanisms, EveryKindOfLoopHolds) {
  for (const JointType type : {JointType::fixed, JointType::ball, JointType::revolute, JointType::universal}) {
    SCOPED_TRACE("joint type " + std::to_string(static_cast<int>(type)));
    description::Model model;
    model.name = "held";
    model.links.push_back(bar("bar", {0, 0, 0}, {0.4, 0, 0}));
    model.joints = {joint_of("shoulder", JointType::ball, Joint::world, 0, Vector3d::UnitZ())};
    Joint loop = joint_of("hand", type, Joint::world, 0, Vector3d::UnitX(), {0.4, 0, 0});
    loop.second_axis.direction = Vector3d::UnitY();
    model.loop_joints = {loop};
    SmallWorld small(space(9.81));
    const auto body = small.add(model, at(0, 0, 1));
    for (int tick = 0; tick < 200; ++tick) {
      small.world().push_body(body, LinkId{0}, {Vector3d(0, 3.0, 0), Vector3d(0.01, 0, 0)});
      small.world().step();
    }
    EXPECT_LT((small.world().link_pose(body, LinkId{0}) * Vector3d(0.4, 0, 0) - Vector3d(0.4, 0, 1)).norm(), 1e-4);
    const double turns = small.world().link_twist(body, LinkId{0}).angular_W.x();
    if (type == JointType::fixed)
      EXPECT_NEAR(turns, 0.0, 1e-6);
    else
      EXPECT_GT(turns, 1.0) << "about itself it is free";
  }
}

// Both hinges turn bars; one follows the other, backwards and twice as fast.
TEST_P(Mechanisms, AFollowerFollowsAndLoadsItsLeader) {
  description::Model model = pair(JointType::revolute, -2.0, 0.0);
  model.devices.emplace_back(description::EffortMotor{"motor", 0, 1.0, 0.0});
  SmallWorld small(space());
  const auto body = small.add(model, at(0, 0, 1));
  small.world().set_joint_target(body, JointId{0}, physics::JointTarget::effort(0.05));
  small.run(0.5);
  const double inertia = solid_box(0.5, {0.22, 0.02, 0.02}).inertia(2, 2) + 0.5 * 0.01;
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).velocity, 0.05 * 0.5 / (inertia + 4.0 * inertia), 1e-4);
  EXPECT_NEAR(small.world().joint_state(body, JointId{1}).position,
              -2.0 * small.world().joint_state(body, JointId{0}).position, 1e-6);
}

TEST_P(Mechanisms, AFollowerKeepsItsOffset) {
  description::Model model = pair(JointType::prismatic, 0.1, 0.3);
  model.devices.emplace_back(description::PositionMotor{"motor", 0, 2.0, 50.0, 0.0});
  SmallWorld small(space(9.81));
  const auto body = small.add(model, at(0, 0, 1));
  small.world().set_joint_target(body, JointId{0}, physics::JointTarget::position(1.0));
  small.run(3.0);
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).position, 1.0, 1e-4);
  EXPECT_NEAR(small.world().joint_state(body, JointId{1}).position, 0.4, 1e-4);
}

// A weight on a frictionless thread turns as it sinks.
TEST_P(Mechanisms, AWeightOnAScrewTurnsAsItSinks) {
  constexpr double pitch = 0.05;
  description::Model nut;
  nut.name = "nut";
  nut.links.push_back({"nut", {}, description::solid_cylinder(1.0, 0.05, 0.02, 0.0), {}});
  Joint screw = joint_of("thread", JointType::screw, Joint::world, 0, Vector3d::UnitZ());
  screw.thread_pitch = pitch;
  nut.joints = {screw};
  SmallWorld small(space(9.81));
  const auto body = small.add(nut, at(0, 0, 1));
  small.run(1.0);
  const double radians_a_metre = 2.0 * M_PI / pitch;
  const double inertia = description::solid_cylinder(1.0, 0.05, 0.02, 0.0).inertia(2, 2);
  const double acceleration = 9.81 / (1.0 + inertia * radians_a_metre * radians_a_metre);
  EXPECT_NEAR(small.velocity(body).z(), -acceleration, 1e-3 * acceleration);
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).position / radians_a_metre, small.position(body).z() - 1.0,
              1e-6);
}

TEST_P(Mechanisms, ContinueFromASnapshotAndReportForces) {
  description::Model model;
  model.name = "frame";
  model.links.push_back(bar("left", {0, 0, 0}, {0, 0, -0.2}));
  model.links.push_back(bar("right", {0.3, 0, 0}, {0, 0, -0.2}));
  model.links.push_back(bar("load", {0, 0, -0.2}, {0.3, 0, 0}));
  const Vector3d y = Vector3d::UnitY();
  model.joints = {joint_of("first", JointType::revolute, Joint::world, 0, y),
                  joint_of("second", JointType::revolute, Joint::world, 1, y),
                  joint_of("third", JointType::revolute, 0, 2, y)};
  model.loop_joints = {joint_of("fourth", JointType::revolute, 1, 2, y, {0.3, 0, 0})};
  model.couplings = {{1, 0, 1.0, 0.0}};
  SmallWorld small(space(9.81));
  const auto body = small.add(model, at(0, 0, 1));
  small.world().record(body);
  small.run(1.0);
  // At rest, each bar carries half of the load.
  EXPECT_NEAR(small.world().joint_wrench(body, JointId{0}).force_W.z(), 0.75 * 9.81, 1e-3);
  EXPECT_NEAR(small.world().joint_wrench(body, JointId{1}).force_W.z(), 0.75 * 9.81, 1e-3);
  SmallWorld restored(small.description);
  restore_from(small.world(), restored.world());
  small.world().push_body(body, LinkId{2}, {Vector3d(5, 0, 0), Vector3d::Zero()});
  restored.world().push_body(body, LinkId{2}, {Vector3d(5, 0, 0), Vector3d::Zero()});
  for (SmallWorld* world : {&small, &restored}) world->run(1.0);
  EXPECT_EQ(hash_of(small.world()), hash_of(restored.world()));
}

}  // namespace
}  // namespace cohort::test
