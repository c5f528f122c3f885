// SPDX-License-Identifier: Apache-2.0

// Bodies of several links in free flight.

#include <gtest/gtest.h>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::JointType;
using Eigen::Vector3d;

class Flight : public EveryPhysics {
 protected:
  description::World space() const {
    description::World world = empty_world();
    world.physics = GetParam().world().physics;
    world.gravity.setZero();
    return world;
  }
  // Returns a model of two links: a hull, and one on a hinge with this axis.
  static description::Model hinged(const description::Inertial& hull, const description::Inertial& other,
                                   const Vector3d& place, const Vector3d& axis) {
    description::Model model;
    model.name = "hinged";
    model.links.push_back({"hull", {}, hull, {}});
    model.links.push_back({"other", {place}, other, {}});
    description::Joint& hinge = model.joints.emplace_back();
    hinge.name = "hinge";
    hinge.type = JointType::revolute;
    hinge.child = 1;
    hinge.axis.direction = axis;
    return model;
  }
  static void expect_kept(SmallWorld& small, BodyId body, double share_of_energy) {
    const WholeMotion before = whole_motion(small, body);
    double least = before.kinetic_energy;
    double most = before.kinetic_energy;
    for (int second = 0; second < 60; ++second) {
      small.run(1.0);
      least = std::min(least, whole_motion(small, body).kinetic_energy);
      most = std::max(most, whole_motion(small, body).kinetic_energy);
    }
    const WholeMotion after = whole_motion(small, body);
    EXPECT_GT(least, (1.0 - share_of_energy) * before.kinetic_energy);
    EXPECT_LT(most, (1.0 + share_of_energy) * before.kinetic_energy);
    EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(), 1e-9 * before.angular_momentum.norm());
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-9);
  }
};
INSTANTIATE_TEST_SUITE_P(Every, Flight, ::testing::Values(treel, by_bullet(treel)), name_of);

TEST_P(Flight, AHullWithASpinningWheelKeepsItsEnergy) {
  SmallWorld small(space());
  const auto body = small.add(hinged(solid_box(1.0, {0.3, 0.2, 0.1}), description::solid_cylinder(0.2, 0.05, 0.02, 0.0),
                                     {0.05, 0.02, 0.1}, Vector3d::UnitZ()),
                              at(0, 0, 0));
  small.world().set_root_twist(body, {Vector3d(0.5, 0.2, 0.1), Vector3d(0.1, 0, 0)});
  const double angle[] = {0.0};
  const double speed[] = {100.0};
  small.world().set_joint_state(body, JointId{0}, angle, speed);
  expect_kept(small, body, 0.01);
}

// The axis of the wheel precesses about the angular momentum, and the hull with it.
TEST_P(Flight, AHullWithAVeryFastWheelTurnsNoFaster) {
  SmallWorld small(space());
  const auto body = small.add(hinged(solid_box(1.0, {0.3, 0.2, 0.1}), description::solid_cylinder(0.2, 0.05, 0.02, 0.0),
                                     {0.05, 0.02, 0.1}, Vector3d::UnitZ()),
                              at(0, 0, 0));
  small.world().set_root_twist(body, {Vector3d(1.0, 0, 0), Vector3d::Zero()});
  const double angle[] = {0.0};
  const double speed[] = {200.0};
  small.world().set_joint_state(body, JointId{0}, angle, speed);
  double fastest = 0.0;
  for (int i = 0; i < 6000; ++i) {
    small.world().step();
    fastest = std::max(fastest, small.world().link_twist(body, LinkId{0}).angular_W.norm());
  }
  EXPECT_NEAR(fastest, 1.0, 0.03);
}

// The motor holds the link in place.
TEST_P(Flight, ATumblingBoxWithALinkOnAMotorKeepsItsEnergy) {
  SmallWorld small(space());
  const Vector3d size(0.3, 0.2, 0.1);
  description::Inertial arm = solid_box(0.05, {0.1, 0.02, 0.02});
  arm.X_LI.position.x() = 0.05;
  description::Model model = hinged(solid_box(1.0, size), arm, {0.15, 0, 0}, Vector3d::UnitY());
  model.devices.emplace_back(description::VelocityMotor{"motor", 0, 1.0, 10.0, 0.0});
  const auto body = small.add(model, at(0, 0, 0));
  small.world().set_root_twist(body, {Vector3d(0.1, 8.0, 0.1), Vector3d::Zero()});
  expect_kept(small, body, 0.01);
}

// In free fall and when pushed: external forces, and only they, change the total momentum.
TEST_P(Flight, OnlyExternalForcesChangeTheTotalMomentum) {
  SmallWorld small(space());
  small.description.gravity = {0, 0, -9.81};
  const auto body = small.add(hinged(solid_box(1.0, {0.3, 0.2, 0.1}), description::solid_cylinder(0.2, 0.05, 0.02, 0.0),
                                     {0.05, 0.02, 0.1}, Vector3d::UnitZ()),
                              at(0, 0, 0));
  const double angle[] = {0.0};
  const double speed[] = {50.0};
  small.world().set_joint_state(body, JointId{0}, angle, speed);
  const WholeMotion before = whole_motion(small, body);
  small.world().push_body(body, LinkId{0}, {Vector3d(3, 0, 0), Vector3d(0, 0.2, 0)});
  small.world().step();
  const WholeMotion after = whole_motion(small, body);
  EXPECT_LT((after.momentum - before.momentum - Vector3d(0.03, 0, -0.01 * 1.2 * 9.81)).norm(), 1e-12);
}

}  // namespace
}  // namespace cohort::test
