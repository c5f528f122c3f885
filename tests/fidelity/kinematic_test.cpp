// SPDX-License-Identifier: Apache-2.0

// Kinematic links: they move as commanded, regardless of contacts.

#include <gtest/gtest.h>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::JointType;
using Eigen::Vector3d;

description::Model kinematic_box(const std::string& name, const Vector3d& size) {
  description::Model model = loose(name, Box{size}, solid_box(1.0, size));
  model.links[0].is_kinematic = true;
  return model;
}

class Kinematic : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, Kinematic, every_physics, name_of);

TEST_P(Kinematic, ABoxPushesObstaclesAndKeepsItsVelocity) {
  SmallWorld small(GetParam().world());
  const auto pusher = small.add(kinematic_box("pusher", {0.2, 0.2, 0.2}), at(0, 0, 0.1));
  const auto pushed =
      small.add(loose("pushed", Box{{0.2, 0.2, 0.2}}, solid_box(50.0, {0.2, 0.2, 0.2})), at(0.5, 0, 0.1));
  small.world().set_root_twist(pusher, {Vector3d::Zero(), Vector3d(0.5, 0, 0)});
  small.run(2.0);
  EXPECT_TRUE(small.position(pusher).isApprox(Vector3d(1.0, 0, 0.1), 1e-12)) << small.position(pusher).transpose();
  EXPECT_NEAR(small.position(pushed).x(), 1.2, 2e-3);
  EXPECT_NEAR(small.velocity(pushed).x(), 0.5, 1e-2);
}

TEST_P(Kinematic, BodiesPassThroughEachOtherAndTheWorld) {
  SmallWorld small(GetParam().world());
  const auto moves = small.add(kinematic_box("moves", {0.2, 0.2, 0.2}), at(0, 0, 0.05));
  const auto stands = small.add(kinematic_box("stands", {0.2, 0.2, 0.2}), at(0.5, 0, 0.05));
  small.world().set_root_twist(moves, {Vector3d::Zero(), Vector3d(1.0, 0, 0)});
  small.run(1.0);
  EXPECT_TRUE(small.position(moves).isApprox(Vector3d(1.0, 0, 0.05), 1e-12)) << small.position(moves).transpose();
  EXPECT_EQ(small.position(stands), Vector3d(0.5, 0, 0.05));
}

class KinematicInSpace : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, KinematicInSpace,
                         ::testing::Values(articulated, by_bullet(articulated), direct, by_bullet(direct)), name_of);

TEST_P(KinematicInSpace, ALiftCarriesItsLoad) {
  SmallWorld small(GetParam().world());
  const auto lift = small.add(kinematic_box("lift", {1.0, 1.0, 0.1}), at(0, 0, 0.5));
  const auto load = small.add(loose("load", Box{{0.2, 0.2, 0.2}}, solid_box(1000.0, {0.2, 0.2, 0.2})), at(0, 0, 0.65));
  small.run(0.5);
  small.world().set_root_twist(lift, {Vector3d::Zero(), Vector3d(0.1, 0, 0.2)});
  small.run(5.0);
  EXPECT_TRUE(small.position(lift).isApprox(Vector3d(0.5, 0, 1.5), 1e-12)) << small.position(lift).transpose();
  EXPECT_NEAR(small.position(load).z(), 1.65, 2e-3);
  EXPECT_NEAR(small.position(load).x(), 0.5, 5e-3) << "it starts within a step or two";
}

// Returns a rod that hangs on a hinge about y.
description::Model rod(bool of_the_world) {
  description::Model model;
  model.name = "pendulum";
  description::Inertial inertial = solid_box(0.5, {0.02, 0.03, 0.4});
  inertial.X_LI.position = {0, 0, -0.2};
  if (!of_the_world) {
    model.links.push_back({"base", {}, solid_box(1.0, {0.1, 0.1, 0.1}), {}});
    model.links[0].is_kinematic = true;
  }
  model.links.push_back({"rod", {}, inertial, {}});
  model.joints.push_back(joint_of("hinge", JointType::revolute, of_the_world ? description::Joint::world : 0,
                                  of_the_world ? 0 : 1, Vector3d::UnitY()));
  return model;
}

TEST_P(KinematicInSpace, AJointedLinkMovesAsOnTheWorld) {
  SmallWorld small(GetParam().world());
  const auto of_the_world = small.add(rod(true), at(0, 0, 2));
  const auto of_a_base = small.add(rod(false), at(0, 1, 2));
  for (const auto body : {of_the_world, of_a_base})
    small.world().set_joint_state(body, JointId{0}, std::vector{1.0}, std::vector{2.0});
  for (int tenth = 0; tenth < 50; ++tenth) {
    small.run(0.1);
    ASSERT_NEAR(small.world().joint_state(of_a_base, JointId{0}).position,
                small.world().joint_state(of_the_world, JointId{0}).position, 1e-6);
  }
  EXPECT_EQ(small.position(of_a_base), Vector3d(0, 1, 2));
}

TEST_P(KinematicInSpace, ARotatingBodyCarriesItsLinks) {
  SmallWorld small(GetParam().world());
  const auto body = small.add(rod(false), at(0, 0, 2));
  const Vector3d rate_W(0, 0, 0.5);
  small.world().set_root_twist(body, {rate_W, Vector3d::Zero()});
  small.run(2.0);
  EXPECT_EQ(small.world().link_twist(body, LinkId{0}).angular_W, rate_W);
  for (const std::size_t link : {0, 1}) {
    const Eigen::Quaterniond turned = small.world().link_pose(body, LinkId{link}).orientation;
    EXPECT_LT(turned.angularDistance(Eigen::Quaterniond(Eigen::AngleAxisd(1.0, Vector3d::UnitZ()))), 1e-9);
  }
}

}  // namespace
}  // namespace cohort::test
