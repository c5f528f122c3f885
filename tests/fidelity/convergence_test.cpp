// SPDX-License-Identifier: Apache-2.0

// Contacts and loops whose errors would grow from step to step if a step did not solve them: at default settings.

#include <gtest/gtest.h>

#include <functional>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::Cylinder;
using description::Joint;
using description::JointType;
using description::Sphere;
using Eigen::Vector3d;

class Convergence : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, Convergence, ::testing::Values(treel, by_bullet(treel)), name_of);

// Six legs of two links carry a platform of 50 kg. One holds it by a joint of the tree, five by joints that close
// loops.
TEST_P(Convergence, AStewartPlatformHoldsItsLoad) {
  description::Model model;
  model.name = "platform";
  const double height = 0.8;
  const auto base = [](int leg) {
    const double angle = M_PI / 3.0 * (leg / 2 * 2) + (leg % 2 == 0 ? -0.2 : 0.2);
    return Vector3d(0.6 * std::cos(angle), 0.6 * std::sin(angle), 0.0);
  };
  const auto top = [&](int leg) {
    const double angle = M_PI / 3.0 * (leg / 2 * 2) + (leg % 2 == 0 ? -M_PI / 3.0 + 0.2 : M_PI / 3.0 - 0.2);
    return Vector3d(0.4 * std::cos(angle), 0.4 * std::sin(angle), height);
  };
  for (int leg = 0; leg < 6; ++leg) {
    const Vector3d way = top(leg) - base(leg);
    const Eigen::Quaterniond along = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), way);
    const Vector3d size(0.04, 0.04, 0.4);
    description::Link lower{"lower" + std::to_string(leg), {base(leg), along}, solid_box(1.0, size), {}};
    lower.inertial.X_LI.position.z() = 0.2;
    description::Link upper{"upper" + std::to_string(leg), {top(leg), along}, solid_box(0.5, size), {}};
    upper.inertial.X_LI.position.z() = -0.2;
    model.links.push_back(lower);
    model.links.push_back(upper);
    const std::size_t first = model.links.size() - 2;
    Joint universal =
        joint_of("foot" + std::to_string(leg), JointType::universal, Joint::world, first, Vector3d::UnitX());
    universal.second_axis.direction = Vector3d::UnitY();
    model.joints.push_back(universal);
    model.joints.push_back(
        joint_of("leg" + std::to_string(leg), JointType::prismatic, first, first + 1, Vector3d::UnitZ()));
    model.devices.emplace_back(
        description::PositionMotor{"leg" + std::to_string(leg), model.joints.size() - 1, 0.5, 2000.0, 0.0});
  }
  model.links.push_back({"platform", {{0, 0, height}}, solid_box(50.0, {0.8, 0.8, 0.05}), {}});
  const std::size_t platform = model.links.size() - 1;
  for (int leg = 0; leg < 6; ++leg) {
    const Joint ball = joint_of("ball" + std::to_string(leg), JointType::ball, static_cast<std::size_t>(2 * leg + 1),
                                platform, Vector3d::UnitZ(), top(leg) - Vector3d(0, 0, height));
    (leg == 0 ? model.joints : model.loop_joints).push_back(ball);
  }
  SmallWorld small(GetParam().world());
  const auto body = small.add(model, at(0, 0, 0.5));
  const auto gap = [&] {
    double widest = 0.0;
    for (int leg = 0; leg < 6; ++leg)
      widest = std::max(widest, (small.world().link_pose(body, LinkId{static_cast<std::size_t>(2 * leg + 1)}).position -
                                 small.world().link_pose(body, LinkId{platform}) * (top(leg) - Vector3d(0, 0, height)))
                                    .norm());
    return widest;
  };
  const auto move_legs = [&](const std::function<double(int)>& position) {
    for (int leg = 0; leg < 6; ++leg)
      small.world().set_joint_target(body, JointId{static_cast<std::size_t>(2 * leg + 1)},
                                     physics::JointTarget::position(position(leg)));
  };
  move_legs([](int) { return 0.0; });
  double held = 0.0;
  for (int i = 0; i < 500; ++i) {
    small.world().step();
    held = std::max(held, gap());
  }
  double moved = 0.0;
  for (int i = 0; i < 1000; ++i) {
    move_legs([&](int leg) { return 0.05 * std::sin(0.01 * i * 2.0 + leg) - 0.05 * std::sin(leg); });
    small.world().step();
    moved = std::max(moved, gap());
  }
  EXPECT_LT(held, 1e-4);
  EXPECT_LT(moved, 1e-4);
}

// Two rims of eight feet, mirror images of each other, walk down a slope.
TEST_P(Convergence, ARimlessWheelGoesStraight) {
  for (const double step : {0.01, 0.002}) {
    SCOPED_TRACE("step " + std::to_string(step));
    const double slope = 8.0 * M_PI / 180.0;
    description::World world = empty_world(std::chrono::microseconds(std::lround(1e6 * step)));
    world.physics = GetParam().world().physics;
    place(world, static_shape("plane", description::Plane{}, {0.8, 0.0}), "plane",
          turned(0, 0, 0, Vector3d::UnitY(), slope));
    SmallWorld small(world);
    description::Model wheel = loose("wheel", Sphere{0.02}, solid_cylinder(2.0, 0.15, 0.3, 0.0));
    wheel.links[0].inertial.inertia = Vector3d(0.03, 0.03, 0.03).asDiagonal();
    wheel.links[0].collisions.clear();
    for (int spoke = 0; spoke < 8; ++spoke)
      for (const double y : {0.15, -0.15}) {
        const double angle = 0.25 * M_PI * spoke;
        wheel.links[0].collisions.push_back({"foot" + std::to_string(spoke) + (y > 0 ? "l" : "r"),
                                             {{0.2 * std::cos(angle), y, 0.2 * std::sin(angle)}},
                                             Sphere{0.02},
                                             {0.8, 0.0}});
      }
    const Vector3d normal(std::sin(slope), 0, std::cos(slope));
    const Vector3d start = 0.23 * normal;
    const auto body = small.add(wheel, turned(start.x(), 0, start.z(), Vector3d::UnitY(), 0.1));
    small.world().set_root_twist(body, {Vector3d(0, 3.0, 0), Vector3d(0.6, 0, 0)});
    small.run(12.0);
    EXPECT_GT(small.position(body).x(), 3.0);
    EXPECT_LT(std::abs(small.position(body).y()), 0.01);
  }
}

// Two fingers on rails press a can of 0.3 kg with a force.
TEST_P(Convergence, AGrippedCanDoesNotSlip) {
  for (const double friction : {0.5, 0.8})
    for (const int step : {1, 2, 5, 10}) {
      SCOPED_TRACE("step " + std::to_string(step) + " ms");
      description::World world = empty_world(std::chrono::milliseconds(step));
      world.physics = GetParam().world().physics;
      world.physics.sleeping = false;
      SmallWorld small(world);
      description::Model gripper;
      gripper.name = "gripper";
      const Vector3d size(0.02, 0.04, 0.06);
      gripper.links.push_back({"palm", {{0, 0, 0.2}}, solid_box(1.0, Vector3d::Constant(0.1)), {}});
      gripper.joints.push_back(joint_of("hand", JointType::fixed, Joint::world, 0, Vector3d::UnitX()));
      for (const double side : {-1.0, 1.0}) {
        gripper.links.push_back({side < 0 ? "left" : "right",
                                 {{side * (0.033 + 0.01), 0, 0}},
                                 solid_box(0.1, size),
                                 {{"pad", {}, Box{size}, {friction, 0.0}}}});
        gripper.joints.push_back(joint_of(gripper.links.back().name, JointType::prismatic, 0, gripper.links.size() - 1,
                                          -side * Vector3d::UnitX()));
        gripper.devices.emplace_back(
            description::EffortMotor{gripper.links.back().name, gripper.joints.size() - 1, 50.0, 0.0});
      }
      const auto hand = small.add(gripper, at(0, 0, 1));
      const auto can = small.add(
          loose("can", Cylinder{0.033, 0.12}, solid_cylinder(0.3, 0.033, 0.12, 0.0), {friction, 0.0}), at(0, 0, 1));
      for (const std::size_t joint : {std::size_t{1}, std::size_t{2}})
        small.world().set_joint_target(hand, JointId{joint}, physics::JointTarget::effort(10.0));
      small.run(1.0);
      const Vector3d before = small.position(can);
      small.run(60.0);
      EXPECT_LT((small.position(can) - before).norm(), 1e-4);
    }
}

// A body of 2 kg hops on a foot of 50 g with a spring, on a rail. The foot loses its share of the energy when it lands.
TEST_P(Convergence, AHoppingLegKeepsItsEnergy) {
  for (const int step : {10, 2}) {
    SCOPED_TRACE("step " + std::to_string(step) + " ms");
    description::World world = GetParam().world();
    world.step = std::chrono::milliseconds(step);
    SmallWorld small(world);
    description::Model leg;
    leg.name = "leg";
    leg.links.push_back({"body", {{0, 0, 0.8}}, solid_box(2.0, Vector3d::Constant(0.1)), {}});
    leg.links.push_back(
        {"foot", {{0, 0, 0.4}}, solid_box(0.05, Vector3d::Constant(0.04)), {{"sole", {}, Sphere{0.02}, {0.8, 0.0}}}});
    leg.joints = {joint_of("rail", JointType::prismatic, Joint::world, 0, Vector3d::UnitZ()),
                  joint_of("spring", JointType::prismatic, 0, 1, Vector3d::UnitZ())};
    leg.joints[1].axis.spring_stiffness = 2000.0;
    const auto body = small.add(leg, {});
    std::vector<double> apexes;
    double before = 0.0;
    bool rises = false;
    for (int i = 0; i < 3000 / step && apexes.size() < 2; ++i) {
      small.world().step();
      const double z = small.position(body).z();
      if (rises && z < before) apexes.push_back(before);
      rises = z > before;
      before = z;
    }
    ASSERT_EQ(apexes.size(), 2u);
    EXPECT_GT(apexes[1], 0.7);
    EXPECT_LT(apexes[1], 0.8);
  }
}

// Hanging links of 0.1 m on ball joints that swing and turn.
TEST_P(Convergence, AChainOfBallJointsKeepsItsEnergy) {
  for (const std::size_t links : {8, 24, 40}) {
    SCOPED_TRACE(std::to_string(links) + " links");
    description::World world = empty_world();
    world.physics = GetParam().world().physics;
    SmallWorld small(world);
    description::Model chain;
    chain.name = "chain";
    const Vector3d size(0.02, 0.02, 0.1);
    for (std::size_t link = 0; link < links; ++link) {
      chain.links.push_back({"link" + std::to_string(link), {{0, 0, -0.1 * static_cast<double>(link)}}, {}, {}});
      chain.links.back().inertial = solid_box(0.1, size);
      chain.links.back().inertial.X_LI.position.z() = -0.05;
      chain.joints.push_back(joint_of("ball" + std::to_string(link), JointType::ball,
                                      link == 0 ? Joint::world : link - 1, link, Vector3d::UnitZ()));
    }
    const auto body = small.add(chain, at(0, 0, 5));
    small.world().set_joint_state(body, JointId{0}, std::array{0.0, 0.0, 0.0, 1.0}, std::array{0.3, 0.5, 0.5});
    const auto energy = [&] {
      const WholeMotion motion = whole_motion(small, body);
      return motion.kinetic_energy + motion.potential_energy;
    };
    const double total = whole_motion(small, body).kinetic_energy;
    const double before = energy();
    double furthest = 0.0;
    for (int i = 0; i < 500; ++i) {
      small.world().step();
      furthest = std::max(furthest, std::abs(energy() - before));
    }
    EXPECT_LT(furthest, 0.03 * total);
  }
}

// Six legs of three joints each. A leg has much angular momentum for the inertia of its first link, which is small, and
// the motors of all legs act against each other over the ground.
double way_of_a_walking_hexapod(description::World world, std::chrono::milliseconds step) {
  world.step = step;
  SmallWorld small(world);
  description::Model model;
  model.name = "hexapod";
  const double height = 0.15;
  const Vector3d size(0.3, 0.2, 0.05);
  model.links.push_back({"hull", {{0, 0, height}}, solid_box(2.0, size), {{"hull", {}, Box{size}, {0.8, 0.0}}}});
  for (int leg = 0; leg < 6; ++leg) {
    const std::string number = std::to_string(leg);
    const double side = leg % 2 == 0 ? 1.0 : -1.0;
    const double x = 0.12 * (leg / 2 - 1);
    const std::size_t first = model.links.size();
    model.links.push_back({"coxa" + number, {{x, 0.1 * side, height}}, solid_box(0.05, Vector3d::Constant(0.04)), {}});
    model.links.push_back({"femur" + number, {{x, 0.15 * side, height}}, solid_box(0.08, {0.03, 0.08, 0.03}), {}});
    model.links.push_back({"tibia" + number,
                           {{x, 0.23 * side, height}},
                           solid_box(0.06, {0.02, 0.02, 0.12}),
                           {{"foot", {{0, 0, -0.12}}, Sphere{0.012}, {0.8, 0.0}}}});
    const Vector3d axes[] = {Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitX()};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string name = "joint" + number + std::to_string(k);
      model.joints.push_back(joint_of(name, JointType::revolute, k == 0 ? 0 : first + k - 1, first + k, axes[k]));
      model.devices.emplace_back(description::PositionMotor{name, model.joints.size() - 1, 6.0, 3.0, 0.0});
    }
  }
  const auto body = small.add(model, at(0, 0, 0));
  // Three legs swing while the other three push, once per second.
  const int steps = static_cast<int>(std::chrono::seconds(12) / step);
  double start = 0.0;
  for (int i = 0; i < steps; ++i) {
    if (i == steps / 6) start = small.position(body).x();
    for (int leg = 0; leg < 6; ++leg) {
      const double side = leg % 2 == 0 ? 1.0 : -1.0;
      const double phase = 24.0 * M_PI * i / steps + ((leg / 2 + leg) % 2 == 0 ? 0.0 : M_PI);
      const double targets[] = {0.25 * side * std::cos(phase), 0.25 * side * std::max(0.0, std::sin(phase)), 0.0};
      for (int k = 0; k < 3; ++k)
        small.world().set_joint_target(body, JointId{static_cast<std::size_t>(3 * leg + k)},
                                       physics::JointTarget::position(targets[k]));
    }
    small.world().step();
  }
  return small.position(body).x() - start;
}

TEST_P(Convergence, AHexapodWalksAsFarWithCoarseSteps) {
  const description::World world = GetParam().world(0.8);
  const double fine = way_of_a_walking_hexapod(world, std::chrono::milliseconds(1));
  EXPECT_GT(fine, 1.0);
  EXPECT_NEAR(way_of_a_walking_hexapod(world, std::chrono::milliseconds(10)), fine, 0.01 * fine);
}

// Five balls touch; the first falls against the others, and the last one swings as far. The error of the others is the
// way that the falling ball makes in a step.
TEST_P(Convergence, OnlyTheLastBallOfACradleSwings) {
  for (const int step : {10, 1}) {
    SCOPED_TRACE("step " + std::to_string(step) + " ms");
    description::World world = empty_world(std::chrono::milliseconds(step));
    world.physics = GetParam().world().physics;
    SmallWorld small(world);
    std::vector<BodyId> balls;
    const double radius = 0.025;
    for (int i = 0; i < 5; ++i) {
      description::Model ball = loose("ball", Sphere{radius}, description::solid_sphere(0.5, radius), {0.0, 1.0});
      ball.joints.push_back(
          joint_of("string", JointType::revolute, Joint::world, 0, Vector3d::UnitY(), Vector3d(0, 0, 0.5)));
      balls.push_back(small.add(ball, at(2.0 * radius * i, 0, 1.0)));
    }
    small.world().set_joint_state(balls[0], JointId{0}, std::array{0.5}, std::array{0.0});
    small.run(0.6);  // it hits after 0.36 s
    std::vector<double> furthest(balls.size(), 0.0);
    for (int i = 600; i < 950; i += step) {
      small.world().step();
      for (std::size_t ball = 0; ball < balls.size(); ++ball)
        furthest[ball] =
            std::max(furthest[ball], std::abs(small.world().joint_state(balls[ball], JointId{0}).position));
    }
    for (std::size_t ball = 0; ball + 1 < balls.size(); ++ball) EXPECT_LT(furthest[ball], 0.004 * step) << ball;
    EXPECT_NEAR(furthest.back(), 0.5, 1e-3);
  }
}

// Three storeys of leaning pairs, with a card on each two neighbouring pairs.
TEST_P(Convergence, AHouseOfCardsStands) {
  SmallWorld small(GetParam().world(0.6));
  const Vector3d size(0.002, 0.063, 0.088);
  const double lean = 0.3;
  const double height = size.z() * std::cos(lean) + size.x() * std::sin(lean);
  const double foot = 0.5 * size.z() * std::sin(lean) + 0.5 * size.x() * std::cos(lean);
  const double width = 4.0 * foot;
  std::vector<std::pair<BodyId, Vector3d>> cards;
  const auto add = [&](double x, double z, double angle) {
    cards.emplace_back(small.add(loose("card", Box{size}, solid_box(0.005, size), {0.6, 0.0}),
                                 turned(x, 0, z, Vector3d::UnitY(), angle)),
                       Vector3d(x, 0, z));
  };
  for (int storey = 0; storey < 3; ++storey) {
    const double floor = storey * (height + size.x());
    for (int pair = 0; pair < 3 - storey; ++pair) {
      const double x = width * (pair + 0.5 * storey);
      add(x - foot, floor + 0.5 * height, lean);
      add(x + foot, floor + 0.5 * height, -lean);
      if (pair + 1 < 3 - storey) add(x + 0.5 * width, floor + height + 0.5 * size.x(), 0.5 * M_PI);
    }
  }
  small.run(60.0);
  double furthest = 0.0;
  for (const auto& [body, place] : cards) furthest = std::max(furthest, (small.position(body) - place).norm());
  EXPECT_LT(furthest, 0.01);
}

}  // namespace
}  // namespace cohort::test
