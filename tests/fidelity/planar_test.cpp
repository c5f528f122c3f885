#include <gtest/gtest.h>

#include "server/core/random.hpp"
#include "tests/support/small_world.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::Cylinder;
using description::Fidelity;
using Eigen::Vector3d;
using physics::Side;

constexpr std::size_t turret = 1;

description::World planar_world(double friction = 1.0) {
  description::World world = world_with_floor(friction);
  world.physics.fidelity = Fidelity::planar;
  return world;
}

description::Model disc(double mass, double radius, description::Surface surface = {}) {
  return loose("disc", Cylinder{radius, 0.04}, solid_cylinder(mass, radius, 0.04, 0.0), surface);
}
description::Model box(double mass, const Vector3d& size, description::Surface surface = {}) {
  return loose("box", Box{size}, solid_box(mass, size), surface);
}

double heading(SmallWorld& small, std::uint32_t body) {
  const Vector3d forward = small.world().link_pose(body, 0).orientation * Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

TEST(Planar, ARobotDrivesAtTheCommandedSpeed) {
  SmallWorld small(planar_world());
  const auto robot = small.add(tracked_robot(), at(0, 0, 0, 0.7));
  small.drive(robot, 0.1, 0.1);
  small.run(0.5);
  const Vector3d start = small.position(robot);
  small.run(2.0);
  EXPECT_NEAR((small.position(robot) - start).norm(), 0.2, 0.2 * 0.005);
  EXPECT_NEAR(small.velocity(robot).x(), 0.1 * std::cos(0.7), 0.1 * 0.005);
  EXPECT_NEAR(small.world().track(robot, 0, Side::left).velocity, 0.1, 0.1 * 0.005);
  EXPECT_EQ(small.position(robot).z(), 0.0);
}

TEST(Planar, ARobotTurnsAsItsTracksDiffer) {
  SmallWorld small(planar_world());
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  small.drive(robot, -0.02, 0.06);
  small.run(0.5);
  EXPECT_NEAR(small.world().link_twist(robot, 0).angular_W.z(), 0.08 / 0.08, 0.005);
  const double before = heading(small, robot);
  small.run(1.0);
  EXPECT_NEAR(heading(small, robot) - before, 1.0, 0.005);
}

TEST(Planar, ARobotToldToStandStillStandsStill) {
  SmallWorld small(planar_world());
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  small.run(10.0);
  EXPECT_EQ(small.position(robot), Vector3d::Zero());
}

TEST(Planar, AWallStopsARobotAndItsTractionIsLimited) {
  for (const double friction : {1.0, 0.1}) {
    SmallWorld small(planar_world(friction));
    const auto robot = small.add(tracked_robot(), at(0, 0, 0));
    small.add(static_shape("wall", Box{{0.1, 2, 0.3}}), at(0.25, 0, 0.15));
    small.drive(robot, 0.1, 0.1);
    small.run(4.0);
    EXPECT_NEAR(small.position(robot).x(), 0.2 - 0.058, 1e-3);
    EXPECT_LT(small.velocity(robot).norm(), 1e-3);
    // The torque of a motor over the radius of the wheels, or friction under half the weight.
    const double most = std::min(0.02 / 0.022, friction * 0.5 * 0.7 * g);
    for (const Side side : {Side::left, Side::right})
      EXPECT_NEAR(small.world().track(robot, 0, side).traction, most, 1e-6);
    ASSERT_EQ(small.world().contacts().size(), 1u);
    EXPECT_NEAR(small.world().contacts()[0].impulse / 0.01, 2.0 * most, 1e-3);
    EXPECT_TRUE(small.world().contacts()[0].normal_W.isApprox(-Vector3d::UnitX(), 1e-9));
  }
}

TEST(Planar, APlaneThatStandsUprightIsAWall) {
  SmallWorld small(planar_world());
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  small.add(static_shape("wall", description::Plane{-Vector3d::UnitX()}), at(0.2, 0, 0));
  small.drive(robot, 0.1, 0.1);
  small.run(4.0);
  EXPECT_NEAR(small.position(robot).x(), 0.2 - 0.058, 1e-3);
}

TEST(Planar, WhatIsLowerThanABodyIsNoWall) {
  SmallWorld small(planar_world());
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  small.add(static_shape("step", Box{{0.1, 2, 0.01}}), at(0.25, 0, 0.005));
  small.add(static_shape("bridge", Box{{0.1, 2, 0.1}}), at(0.25, 0, 0.2));
  small.drive(robot, 0.1, 0.1);
  small.run(6.0);
  EXPECT_GT(small.position(robot).x(), 0.5);
}

TEST(Planar, RobotsInACrowdNeverPassThroughEachOther) {
  SmallWorld small(planar_world());
  std::vector<std::uint32_t> robots;
  for (int i = 0; i < 36; ++i) robots.push_back(small.add(tracked_robot(), at(0.13 * (i % 6), 0.13 * (i / 6), 0, i)));
  for (const double x : {-0.15, 0.8}) small.add(static_shape("wall", Box{{0.1, 2, 0.3}}), at(x, 0.3, 0.15));
  for (const double y : {-0.15, 0.8}) small.add(static_shape("wall", Box{{2, 0.1, 0.3}}), at(0.3, y, 0.15));
  const RandomStream random(1, "planar", "crowd");
  for (int tick = 0; tick < 2000; ++tick) {
    for (std::uint32_t i = 0; i < robots.size(); ++i)
      small.drive(robots[i], 0.4 * random.uniform(tick / 50, 2 * i) - 0.2,
                  0.4 * random.uniform(tick / 50, 2 * i + 1) - 0.2);
    small.world().step();
    for (std::size_t i = 0; i < robots.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        ASSERT_GT((small.position(robots[i]) - small.position(robots[j])).norm(), 2 * 0.058 - 4e-3) << tick;
      ASSERT_LT((small.position(robots[i]).head<2>() - Eigen::Vector2d(0.325, 0.325)).cwiseAbs().maxCoeff(),
                0.425 - 0.058 + 4e-3);
    }
  }
}

TEST(Planar, MomentumStaysInACollisionOfDiscs) {
  SmallWorld small(planar_world(0.0));
  const description::Surface bouncy{0.5, 0.9};
  const auto one = small.add(disc(1.0, 0.05, bouncy), at(-0.5, 0, 0.02));
  const auto two = small.add(disc(3.0, 0.05, bouncy), at(0, 0.03, 0.02));
  small.world().set_root_twist(one, {Vector3d(0, 0, 3), Vector3d(1, 0, 0)});
  const auto angular_momentum = [&] {
    double sum = 0.0;
    for (const auto& [body, mass] : {std::pair{one, 1.0}, std::pair{two, 3.0}}) {
      sum += mass * small.position(body).cross(small.velocity(body)).z();
      sum += 0.5 * mass * 0.05 * 0.05 * small.world().link_twist(body, 0).angular_W.z();
    }
    return sum;
  };
  const double before = angular_momentum();
  small.run(2.0);
  const Vector3d momentum = 1.0 * small.velocity(one) + 3.0 * small.velocity(two);
  EXPECT_TRUE(momentum.isApprox(Vector3d(1, 0, 0), 1e-9)) << momentum.transpose();
  EXPECT_NEAR(angular_momentum(), before, 1e-9);
  EXPECT_GT(small.velocity(two).x(), 0.3);
}

TEST(Planar, DiscsBounceByTheirRestitution) {
  SmallWorld small(planar_world(0.0));
  const description::Surface bouncy{0.0, 0.8};
  const auto one = small.add(disc(1.0, 0.05, bouncy), at(-0.5, 0, 0.02));
  const auto two = small.add(disc(1.0, 0.05, bouncy), at(0, 0, 0.02));
  small.world().set_root_twist(one, {Vector3d::Zero(), Vector3d(1, 0, 0)});
  small.run(1.0);
  EXPECT_NEAR(small.velocity(one).x(), 0.1, 1e-6);
  EXPECT_NEAR(small.velocity(two).x(), 0.9, 1e-6);
}

TEST(Planar, FrictionStopsASlidingPuck) {
  for (const double direction : {0.0, 0.7, 2.0}) {
    SmallWorld small(planar_world(0.3));
    const auto puck = small.add(disc(0.5, 0.04), at(0, 0, 0.02));
    small.world().set_root_twist(puck, {Vector3d::Zero(), Vector3d(std::cos(direction), std::sin(direction), 0)});
    small.run(1.0);
    const Vector3d way = small.position(puck) - Vector3d(0, 0, 0.02);
    EXPECT_NEAR(way.norm(), 1.0 / (2.0 * 0.3 * g), 0.006);  // v^2 / (2 mu g), and half a step
    EXPECT_NEAR(std::atan2(way.y(), way.x()), direction, 1e-9);
    EXPECT_EQ(small.velocity(puck).norm(), 0.0);
  }
}

TEST(Planar, FrictionStopsASpinningPuck) {
  SmallWorld small(planar_world(0.3));
  const auto puck = small.add(disc(0.5, 0.04), at(0, 0, 0.02));
  small.world().set_root_twist(puck, {Vector3d(0, 0, 5), Vector3d::Zero()});
  // The torque 2/3 mu m g r on the inertia m r^2 / 2 stops it after w r / (4/3 mu g).
  const double stops = 5.0 * 0.04 / (4.0 / 3.0 * 0.3 * g);
  small.run(0.5 * stops);
  EXPECT_NEAR(small.world().link_twist(puck, 0).angular_W.z(), 2.5, 0.5);
  small.run(0.5 * stops + 0.02);
  EXPECT_EQ(small.world().link_twist(puck, 0).angular_W.z(), 0.0);
}

TEST(Planar, APairOfMaterialsHasItsOwnFriction) {
  SmallWorld small(planar_world());
  small.description.materials = {"", "ice", "felt"};
  small.description.material_pairs = {{1, 2, 0.1, 0.0, 0.0}};
  small.description.models[0].links[0].collisions[0].surface.material = 1;
  description::Surface felt;
  felt.material = 2;
  const auto puck = small.add(disc(0.5, 0.04, felt), at(0, 0, 0.02));
  small.world().set_root_twist(puck, {Vector3d::Zero(), Vector3d(0.5, 0, 0)});
  small.run(1.0);
  EXPECT_NEAR(small.position(puck).x(), 0.25 / (2.0 * 0.1 * g), 0.003);
}

TEST(Planar, ARobotPushesALooseBox) {
  SmallWorld small(planar_world(0.3));
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  const auto loose_box = small.add(box(0.3, {0.1, 0.1, 0.1}), at(0.15, 0, 0.05));
  small.drive(robot, 0.1, 0.1);
  small.run(4.0);
  EXPECT_GT(small.position(loose_box).x(), 0.4);
  EXPECT_NEAR(small.position(loose_box).x() - small.position(robot).x(), 0.05 + 0.058, 1e-3);
  EXPECT_NEAR(small.velocity(loose_box).x(), 0.1, 0.002);
}

TEST(Planar, ABoxPushedAtItsEdgeTurns) {
  SmallWorld small(planar_world(0.3));
  const auto robot = small.add(tracked_robot(), at(0, 0.06, 0));
  const auto loose_box = small.add(box(0.3, {0.1, 0.2, 0.1}), at(0.15, 0, 0.05));
  small.drive(robot, 0.1, 0.1);
  small.run(1.5);
  EXPECT_LT(heading(small, loose_box), -0.1);
}

TEST(Planar, BoxesInARowStayBeforeTheWallTheyArePushedAgainst) {
  SmallWorld small(planar_world(0.1));
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  const auto first = small.add(box(0.2, {0.1, 0.1, 0.1}), at(0.12, 0, 0.05));
  const auto second = small.add(box(0.2, {0.1, 0.1, 0.1}), at(0.24, 0.01, 0.05));
  small.add(static_shape("wall", Box{{0.1, 2, 0.3}}), at(0.4, 0, 0.15));
  small.drive(robot, 0.1, 0.1);
  small.run(6.0);
  EXPECT_NEAR(small.position(second).x(), 0.35 - 0.05, 2e-3);
  EXPECT_NEAR(small.position(first).x(), 0.35 - 0.15, 2e-3);
  EXPECT_NEAR(small.position(robot).x(), 0.35 - 0.2 - 0.058, 2e-3);
  EXPECT_NEAR(heading(small, second), 0.0, 0.02);
}

TEST(Planar, ALyingCapsuleIsPushedByItsSideAndByItsEnd) {
  for (const double yaw : {0.0, M_PI / 2}) {
    SmallWorld small(planar_world(0.3));
    const auto robot = small.add(tracked_robot(), at(0, 0, 0));
    Pose X_WM = at(0.2, 0, 0.05, yaw);
    X_WM.orientation = X_WM.orientation * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY());
    const auto capsule =
        small.add(loose("capsule", description::Capsule{0.04, 0.1}, solid_box(0.2, {0.1, 0.1, 0.2})), X_WM);
    const auto block = small.add(box(0.2, {0.1, 0.1, 0.1}), at(0.36, 0, 0.05));
    small.drive(robot, 0.1, 0.1);
    small.run(4.0);
    const double reach = yaw == 0.0 ? 0.05 + 0.04 : 0.04;
    EXPECT_NEAR(small.position(capsule).x() - small.position(robot).x(), reach + 0.058, 2e-3);
    EXPECT_NEAR(small.position(block).x() - small.position(capsule).x(), reach + 0.05, 2e-3);
    EXPECT_GT(small.position(block).x(), 0.45);
  }
}

TEST(Planar, AMotorTurnsItsJointAsCommandedUpToItsLimit) {
  description::Model model = tracked_robot();
  model.joints[0].axis.upper = 1.0;
  SmallWorld small(planar_world());
  const auto robot = small.add(model, at(0, 0, 0, 0.3));
  small.world().set_joint_velocity_target(robot, 0, 0.5);
  small.run(1.0);
  EXPECT_NEAR(small.world().joint_position(robot, 0), 0.5, 1e-9);
  EXPECT_EQ(small.world().joint_velocity(robot, 0), 0.5);
  EXPECT_NEAR(small.world().link_twist(robot, turret).angular_W.z(), 0.5, 1e-9);
  const Vector3d forward = small.world().link_pose(robot, turret).orientation * Vector3d::UnitX();
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), 0.8, 1e-9);
  small.run(2.0);
  EXPECT_NEAR(small.world().joint_position(robot, 0), 1.0, 1e-9);
  EXPECT_EQ(small.world().joint_velocity(robot, 0), 0.0);
}

TEST(Planar, WhatATurretCarriesSweepsAwayWhatIsLoose) {
  description::Model model = tracked_robot();
  model.links[turret].collisions.push_back({"arm", {{0.1, 0, 0.02}}, Box{{0.1, 0.02, 0.02}}, {0.3, 0}});
  SmallWorld small(planar_world(0.3));
  const auto robot = small.add(model, at(0, 0, 0));
  const auto post =
      small.add(loose("post", Cylinder{0.02, 0.2}, solid_cylinder(0.05, 0.02, 0.2, 0.0)), at(0.08, 0.1, 0.1));
  small.world().set_joint_velocity_target(robot, 0, 1.0);
  small.run(2.0);
  EXPECT_LT(small.position(post).x(), 0.02) << "swept along";
  EXPECT_GT((small.position(post) - small.position(robot)).head<2>().norm(), 0.058 + 0.02 - 2e-3);
}

TEST(Planar, GoesWhereTheFullModelGoesOnFreeGround) {
  const auto end_of = [](Fidelity fidelity, double left, double right) {
    SmallWorld small;
    small.description.physics.fidelity = fidelity;
    const auto robot = small.add(tracked_robot(), at(0, 0, 0, 0.4));
    small.drive(robot, left, right);
    small.run(2.0);
    small.drive(robot, right, left);
    small.run(3.0);
    return small.position(robot);
  };
  for (const auto& [left, right] : {std::pair{0.1, 0.1}, std::pair{0.05, 0.15}, std::pair{-0.1, 0.02}}) {
    const Vector3d planar = end_of(Fidelity::planar, left, right);
    const Vector3d full = end_of(Fidelity::treel, left, right);
    EXPECT_LT((planar - full).head<2>().norm(), 5e-3) << left << " " << right;
  }
}

constexpr double spacing = 0.13;

// Robots in a row, each turret held to the one before.
struct Chain {
  SmallWorld small{planar_world()};
  std::vector<std::uint32_t> robots;
  std::vector<std::uint32_t> connections;

  explicit Chain(int count, const physics::ConnectionLimits& limits = {}) {
    for (int i = 0; i < count; ++i) robots.push_back(small.add(tracked_robot(), at(spacing * i, 0, 0)));
    for (std::size_t i = 1; i < robots.size(); ++i)
      connections.push_back(
          small.world().connect(robots[i - 1], turret, {{0.5 * spacing, 0, 0.02}}, robots[i], turret, limits));
  }
  double gap() {
    double greatest = 0.0;
    for (std::size_t i = 1; i < robots.size(); ++i) {
      const Vector3d a = small.world().link_pose(robots[i - 1], turret) * Vector3d(0.5 * spacing, 0, 0.02);
      const Vector3d b = small.world().link_pose(robots[i], turret) * Vector3d(-0.5 * spacing, 0, 0.02);
      greatest = std::max(greatest, (a - b).norm());
    }
    return greatest;
  }
};

TEST(Planar, TwentyFiveInAChainThatAllPullElsewhereStayWithinTwoMillimetres) {
  Chain chain(25);
  const RandomStream random(1, "chain", "drive");
  for (int tick = 0; tick < 1000; ++tick) {
    for (std::size_t i = 0; i < chain.robots.size(); ++i) {
      const auto draw = static_cast<std::uint32_t>(3 * i);
      chain.small.drive(chain.robots[i], 0.4 * random.uniform(tick / 20, draw) - 0.2,
                        0.4 * random.uniform(tick / 20, draw + 1) - 0.2);
      chain.small.world().set_joint_velocity_target(chain.robots[i], 0,
                                                    2.0 * random.uniform(tick / 20, draw + 2) - 1.0);
    }
    chain.small.world().step();
    ASSERT_LT(chain.gap(), 2e-3) << "at tick " << tick;
  }
}

TEST(Planar, AConnectionReportsTheForceThatGoesThroughIt) {
  Chain chain(2);
  const auto held = chain.small.world().connect(chain.robots[0], 0, {}, 0, 0);
  chain.small.drive(chain.robots[1], 0.2, 0.2);
  chain.small.run(2.0);
  const double pull = 2.0 * 0.02 / 0.022;
  EXPECT_NEAR(chain.small.world().connection_wrench(chain.connections[0]).force_W.x(), pull, 0.01);
  double own = 0.0;
  for (const Side side : {Side::left, Side::right}) own += chain.small.world().track(chain.robots[0], 0, side).traction;
  EXPECT_NEAR(chain.small.world().connection_wrench(held).force_W.x() + own, -pull, 0.01);
}

TEST(Planar, AConnectionBreaksWhereItBearsLess) {
  Chain chain(3, {.force = 1.0});
  chain.small.drive(chain.robots[0], -0.2, -0.2);
  chain.small.drive(chain.robots[2], 0.2, 0.2);
  std::vector<std::uint32_t> broken;
  for (int tick = 0; tick < 200; ++tick) {
    chain.small.world().step();
    const auto now = chain.small.world().broken_connections();
    broken.insert(broken.end(), now.begin(), now.end());
  }
  EXPECT_FALSE(broken.empty());
  for (const std::uint32_t connection : broken) EXPECT_FALSE(chain.small.world().is_connected(connection));
  EXPECT_GT(chain.gap(), 0.1);
}

}  // namespace
}  // namespace cohort::test
