// SPDX-License-Identifier: Apache-2.0

// The convex solver: scenes that stand, drive and mirror each other as their equations say, at any step.

#include <gtest/gtest.h>

#include <tuple>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::Cylinder;
using description::Dynamics;
using description::Joint;
using description::JointType;
using description::Model;
using description::Sphere;
using Eigen::Vector3d;
using physics::JointTarget;

class Convex : public ::testing::TestWithParam<std::tuple<int, Dynamics>> {
 protected:
  description::World world(double friction = 1.0) const {
    description::World world = world_with_floor(friction);
    world.step = std::chrono::milliseconds(std::get<0>(GetParam()));
    world.physics.solver = description::Solver::convex;
    world.physics.dynamics = std::get<1>(GetParam());
    world.physics.fidelity = description::Fidelity::articulated;
    return world;
  }
};
std::string name_of_step(const ::testing::TestParamInfo<std::tuple<int, Dynamics>>& tested) {
  const auto [step, dynamics] = tested.param;
  return std::to_string(step) + (dynamics == Dynamics::bullet ? "ms_bullet" : "ms");
}
INSTANTIATE_TEST_SUITE_P(AtAnyStep, Convex,
                         ::testing::Combine(::testing::Values(10, 5, 2, 1),
                                            ::testing::Values(Dynamics::cohort, Dynamics::bullet)),
                         name_of_step);

constexpr std::size_t left = 0, right = 1;  // joints of a driven base

// A base on two wheels, each turned by a motor, and on frictionless balls in front and behind. Statics alone does not
// tell how these four share the weight.
Model driven_base(const description::Shape& wheel) {
  Model model = loose("base", Box{{0.3, 0.2, 0.05}}, solid_box(5.0, {0.4, 0.3, 0.1}));
  model.links[0].collisions.clear();
  model.links[0].X_ML.position = {0, 0, 0.1};
  for (const double x : {0.2, -0.2})
    model.links[0].collisions.push_back({"ball", {{x, 0, -0.05}}, Sphere{0.05}, {0.0, 0.0}});
  for (const double y : {0.2, -0.2}) {
    const std::size_t joint = add_wheel(model, {0, y, 0.1}, 0.1, 0.05, 0.5);
    model.links.back().collisions[0].shape = wheel;
    model.devices.push_back(description::VelocityMotor{"motor" + std::to_string(joint), joint, 30.0, 5.0});
  }
  return model;
}

void turn_wheels(SmallWorld& small, BodyId body, double of_left, double of_right) {
  small.world().set_joint_target(body, JointId{left}, JointTarget::velocity(of_left));
  small.world().set_joint_target(body, JointId{right}, JointTarget::velocity(of_right));
}

TEST_P(Convex, ADriveOnTwoCastersDrivesBrakesAndReverses) {
  SmallWorld small(world());
  const BodyId base = small.add(driven_base(Sphere{0.1}), at(0, 0, 0));
  turn_wheels(small, base, 5.0, 5.0);
  small.run(1.0);
  EXPECT_NEAR(small.velocity(base).x(), 0.5, 1e-5);
  turn_wheels(small, base, 0.0, 0.0);
  small.run(0.5);
  EXPECT_NEAR(small.velocity(base).x(), 0.0, 1e-5);
  turn_wheels(small, base, -5.0, -5.0);
  small.run(1.0);
  EXPECT_NEAR(small.velocity(base).x(), -0.5, 1e-5);
  EXPECT_NEAR(small.position(base).y(), 0.0, 1e-9) << "nothing pulls it aside";
  EXPECT_NEAR(small.position(base).z(), 0.1, 1e-5);
}

TEST_P(Convex, WideWheelsTurnTheSameBothWays) {
  const auto turn = [&](double speed) {
    SmallWorld small(world());
    const BodyId base = small.add(driven_base(Cylinder{0.1, 0.05}), at(0, 0, 0));
    turn_wheels(small, base, -speed, speed);
    small.run(3.0);
    const Vector3d ahead = small.world().link_pose(base, LinkId{0}).orientation * Vector3d::UnitX();
    const double rate = small.world().link_twist(base, LinkId{0}).angular_W.z();
    EXPECT_NEAR(rate, speed * 0.1 / 0.2, 0.02 * std::abs(speed) * 0.1 / 0.2) << "as if all stood on its middle";
    return std::pair{ahead, rate};
  };
  const auto [ahead, rate] = turn(2.0);
  const auto [mirrored, opposite] = turn(-2.0);
  EXPECT_NEAR(rate, -opposite, 1e-9);
  EXPECT_NEAR(ahead.x(), mirrored.x(), 1e-9);
  EXPECT_NEAR(ahead.y(), -mirrored.y(), 1e-9);
}

TEST_P(Convex, ATowerOfTwentyBoxesStandsAndSleeps) {
  SmallWorld small(world());
  std::vector<BodyId> boxes;
  std::vector<Vector3d> places;
  for (int i = 0; i < 20; ++i) {
    places.emplace_back(0.003 * ((7 * i) % 3 - 1), 0.003 * ((5 * i) % 3 - 1), 0.05 + 0.1 * i);
    boxes.push_back(small.add(loose("box", Box{Vector3d::Constant(0.1)}, solid_box(1.0, Vector3d::Constant(0.1))),
                              {places.back()}));
  }
  small.run(2.0);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_NEAR((small.position(boxes[i]) - places[i]).norm(), 0.0, 1e-5) << i;
    EXPECT_TRUE(small.world().is_asleep(boxes[i])) << i;
  }
}

TEST_P(Convex, AHeavyBoxOnALightOneStands) {
  SmallWorld small(world());
  const Vector3d size = Vector3d::Constant(0.1);
  const BodyId light = small.add(loose("light", Box{size}, solid_box(0.01, size)), at(0, 0, 0.05));
  const BodyId heavy = small.add(loose("heavy", Box{size}, solid_box(100.0, size)), at(0.01, 0, 0.15));
  small.run(2.0);
  EXPECT_NEAR((small.position(heavy) - Vector3d(0.01, 0, 0.15)).norm(), 0.0, 1e-5);
  EXPECT_NEAR((small.position(light) - Vector3d(0, 0, 0.05)).norm(), 0.0, 1e-5);
  EXPECT_TRUE(small.world().is_asleep(heavy));
}

description::Mesh prism(int corners, double radius, double height) {
  auto mesh = std::make_shared<description::TriangleMesh>();
  for (int corner = 0; corner < corners; ++corner) {
    const double angle = 2.0 * M_PI * corner / corners;
    for (const double z : {-0.5 * height, 0.5 * height})
      mesh->vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  for (std::uint32_t i = 2; i < mesh->vertices.size(); ++i) mesh->triangles.push_back({i - 2, i - 1, i});
  return {mesh, true};
}

TEST_P(Convex, HullsComeToRestOnAnyOfTheirSides) {
  SmallWorld small(world());
  std::vector<BodyId> hulls;
  for (int i = 0; i < 8; ++i) {
    const double radius = 0.02 + 0.01 * i;
    hulls.push_back(small.add(loose("hull", prism(5 + i, radius, radius), solid_cylinder(1.0, radius, radius, 0.0)),
                              turned(0.5 * i, 0, 2.0 * radius, {1.0, 0.3 * i, 0.2}, 0.5 * i)));
  }
  small.run(4.0);
  for (std::size_t i = 0; i < hulls.size(); ++i) EXPECT_TRUE(small.world().is_asleep(hulls[i])) << i;
}

// Sixteen feet on two rims: it rolls down a slope from foot to foot.
TEST_P(Convex, ARimlessWheelRollsStraight) {
  description::World sloping = world();
  sloping.gravity = {1.5, 0.0, -9.7};
  SmallWorld small(std::move(sloping));
  Model model = loose("wheel", Sphere{0.02}, solid_sphere(2.0, 0.3));
  model.links[0].collisions.clear();
  for (int spoke = 0; spoke < 8; ++spoke)
    for (const double y : {0.1, -0.1}) {
      const double angle = M_PI / 4.0 * spoke;
      model.links[0].collisions.push_back(
          {"foot", {{0.3 * std::sin(angle), y, 0.3 * std::cos(angle)}}, Sphere{0.02}, {1.0, 0.0}});
    }
  const BodyId wheel = small.add(model, at(0, 0, 0.32));
  small.world().set_root_twist(wheel, {{0.0, 4.0, 0.0}, {1.2, 0.0, 0.0}});
  small.run(4.0);
  EXPECT_GT(small.position(wheel).x(), 2.0);
  EXPECT_NEAR(small.position(wheel).y(), 0.0, 1e-9);
}

// Two fingers press on a box from both sides, beside its centre. A lift that can carry little more raises them gently.
TEST_P(Convex, ABoxBetweenTwoFingersIsLiftedLevel) {
  SmallWorld small(world(0.5));
  Model gripper;
  gripper.name = "gripper";
  gripper.links.push_back({"lift", {{0, 0, 0.5}}, solid_box(1.0, {0.1, 0.1, 0.1}), {}});
  gripper.joints.push_back(joint_of("lift", JointType::prismatic, Joint::world, 0, Vector3d::UnitZ()));
  gripper.devices.push_back(description::PositionMotor{"lift", 0, 0.2, 17.0});
  for (const double side : {1.0, -1.0}) {
    const std::size_t link = gripper.links.size();
    gripper.links.push_back({"finger" + std::to_string(link),
                             {{0.06 * side, 0, 0.04}},
                             solid_box(0.1, {0.02, 0.04, 0.04}),
                             {{"pad", {}, Box{{0.02, 0.04, 0.04}}, {0.5, 0.0}}}});
    gripper.joints.push_back(
        joint_of("slide" + std::to_string(link), JointType::prismatic, 0, link, Vector3d(-side, 0, 0)));
    gripper.devices.push_back(description::EffortMotor{"press" + std::to_string(link), link, 20.0});
  }
  const BodyId hand = small.add(gripper, at(0, 0, 0));
  const BodyId box =
      small.add(loose("box", Box{Vector3d::Constant(0.08)}, solid_box(0.4, Vector3d::Constant(0.08)), {0.5, 0.0}),
                at(0.002, 0.004, 0.04));
  for (const std::size_t finger : {1u, 2u})
    small.world().set_joint_target(hand, JointId{finger}, JointTarget::effort(8.0));
  small.run(0.5);
  small.world().set_joint_target(hand, JointId{0}, JointTarget::position(0.2));
  small.run(3.0);
  const Pose after = small.world().link_pose(box, LinkId{0});
  EXPECT_NEAR(after.position.z(), 0.24, 1e-4);
  EXPECT_NEAR((after.orientation * Vector3d::UnitZ()).z(), 1.0, 1e-9) << "level";
}

TEST_P(Convex, ARobotOnFourLegsStandsStillAndSleeps) {
  SmallWorld small(world());
  Model model = loose("robot", Box{{0.4, 0.2, 0.1}}, solid_box(8.0, {0.4, 0.2, 0.1}));
  model.links[0].X_ML.position = {0, 0, 0.4};
  for (const double x : {0.18, -0.18})
    for (const double y : {0.12, -0.12}) {
      const std::size_t thigh = model.links.size();
      for (std::size_t part = 0; part < 2; ++part) {
        const std::string name = std::to_string(thigh + part);
        const double z = part == 0 ? 0.32 : 0.14;
        model.links.push_back({"leg" + name, {{x, y, z}}, solid_box(0.5, {0.03, 0.03, 0.16}), {}});
        model.joints.push_back(joint_of("joint" + name, JointType::revolute, part == 0 ? 0 : thigh, thigh + part,
                                        Vector3d::UnitY(), {0, 0, 0.09}));
        model.devices.push_back(description::VelocityMotor{"motor" + name, model.joints.size() - 1, 5.0, 40.0});
      }
      model.links.back().collisions.push_back({"foot", {{0, 0, -0.12}}, Sphere{0.02}, {1.0, 0.0}});
    }
  const BodyId robot = small.add(model, at(0, 0, 0));
  small.run(3.0);
  EXPECT_NEAR((small.position(robot) - Vector3d(0, 0, 0.4)).norm(), 0.0, 1e-5);
  EXPECT_TRUE(small.world().is_asleep(robot));
}

// Robots with tracks that push each other, boxes and hulls.
class ConvexBits : public Convex {};
INSTANTIATE_TEST_SUITE_P(At, ConvexBits,
                         ::testing::Combine(::testing::Values(10),
                                            ::testing::Values(Dynamics::cohort, Dynamics::bullet)),
                         name_of_step);

TEST_P(ConvexBits, AreTheSameForAnyNumberOfThreadsAndAfterARestore) {
  const auto hash_after = [&](unsigned threads, bool restores) {
    const auto create = [&] {
      description::World its = world();
      its.physics.fidelity = description::Fidelity::treel;
      auto small = std::make_unique<SmallWorld>(std::move(its), threads);
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
          small->add(tracked_robot(), at(0.13 * column, 0.13 * row, 0, 4 * row + column));
      for (int i = 0; i < 6; ++i) {
        small->add(loose("box", Box{Vector3d::Constant(0.05)}, solid_box(0.2, Vector3d::Constant(0.05))),
                   at(-0.1, 0.06 * i, 0.03 + 0.02 * i));
        small->add(loose("hull", prism(6, 0.03, 0.04), solid_cylinder(0.2, 0.03, 0.04, 0.0)),
                   turned(0.5, 0.05 * i, 0.1, {1, 2, 3}, i));
      }
      for (std::uint32_t i = 0; i < 12; ++i) small->drive(BodyId{i + 1}, 0.1, 0.15 - 0.01 * i);
      return small;
    };
    std::unique_ptr<SmallWorld> small = create();
    small->run(1.0);
    if (restores) {
      std::unique_ptr<SmallWorld> restored = create();
      restore_from(small->world(), restored->world());
      small = std::move(restored);
    }
    small->run(1.0);
    return hash_of(small->world());
  };
  const std::uint64_t expected = hash_after(1, false);
  for (const unsigned threads : {2u, 3u}) EXPECT_EQ(hash_after(threads, false), expected) << threads;
  EXPECT_EQ(hash_after(1, true), expected) << "restored";
}

}  // namespace
}  // namespace cohort::test
