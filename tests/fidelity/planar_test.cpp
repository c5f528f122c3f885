// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/core/random.hpp"
#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::Cylinder;
using description::Fidelity;
using Eigen::Vector3d;

description::Model disc(double mass, double radius, description::Surface surface = {}) {
  return loose("disc", Cylinder{radius, 0.04}, solid_cylinder(mass, radius, 0.04, 0.0), surface);
}
description::Model box(double mass, const Vector3d& size, description::Surface surface = {}) {
  return loose("box", Box{size}, solid_box(mass, size), surface);
}

double heading(SmallWorld& small, BodyId body) {
  const Vector3d forward = small.world().link_pose(body, LinkId{0}).orientation * Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

TEST(Planar, ARobotDrivesAtTheCommandedSpeed) {
  SmallWorld small(planar.world());
  const auto robot = small.add(tracked_robot(), at(0, 0, 0, 0.7));
  small.drive(robot, 0.1, 0.1);
  small.run(0.5);
  const Vector3d start = small.position(robot);
  small.run(2.0);
  EXPECT_NEAR((small.position(robot) - start).norm(), 0.2, 0.2 * 0.005);
  EXPECT_NEAR(small.velocity(robot).x(), 0.1 * std::cos(0.7), 0.1 * 0.005);
  EXPECT_NEAR(small.world().device_state(robot, DeviceId{0}, 0).velocity, 0.1, 0.1 * 0.005);
  EXPECT_EQ(small.position(robot).z(), 0.0);
}

TEST(Planar, ARobotTurnsByTheDifferenceOfItsTracks) {
  SmallWorld small(planar.world());
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  small.drive(robot, -0.02, 0.06);
  small.run(0.5);
  EXPECT_NEAR(small.world().link_twist(robot, LinkId{0}).angular_W.z(), 0.08 / 0.08, 0.005);
  const double before = heading(small, robot);
  small.run(1.0);
  EXPECT_NEAR(heading(small, robot) - before, 1.0, 0.005);
}

TEST(Planar, ARobotCommandedToStandStillStandsStill) {
  SmallWorld small(planar.world());
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  small.run(10.0);
  EXPECT_EQ(small.position(robot), Vector3d::Zero());
}

TEST(Planar, AWallStopsARobotAndItsTractionIsLimited) {
  for (const double friction : {1.0, 0.1}) {
    SmallWorld small(planar.world(friction));
    const auto robot = small.add(tracked_robot(), at(0, 0, 0));
    small.add(static_shape("wall", Box{{0.1, 2, 0.3}}), at(0.25, 0, 0.15));
    small.drive(robot, 0.1, 0.1);
    small.run(4.0);
    EXPECT_NEAR(small.position(robot).x(), 0.2 - 0.058, 1e-3);
    EXPECT_LT(small.velocity(robot).norm(), 1e-3);
    // The limit is the torque of a motor over the radius of the wheels, or friction under half the weight.
    const double most = std::min(0.02 / 0.022, friction * 0.5 * 0.7 * g);
    for (const std::size_t side : {0, 1})
      EXPECT_NEAR(small.world().device_state(robot, DeviceId{0}, side).effort, most, 1e-6);
    ASSERT_EQ(small.world().contacts().size(), 1u);
    EXPECT_NEAR(small.world().contacts()[0].impulse / 0.01, 2.0 * most, 1e-3);
    EXPECT_TRUE(small.world().contacts()[0].normal_W.isApprox(-Vector3d::UnitX(), 1e-9));
  }
}

TEST(Planar, AnUprightPlaneIsAWall) {
  SmallWorld small(planar.world());
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  small.add(static_shape("wall", description::Plane{-Vector3d::UnitX()}), at(0.2, 0, 0));
  small.drive(robot, 0.1, 0.1);
  small.run(4.0);
  EXPECT_NEAR(small.position(robot).x(), 0.2 - 0.058, 1e-3);
}

TEST(Planar, AnObjectLowerThanABodyIsNoWall) {
  SmallWorld small(planar.world());
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  small.add(static_shape("step", Box{{0.1, 2, 0.01}}), at(0.25, 0, 0.005));
  small.add(static_shape("bridge", Box{{0.1, 2, 0.1}}), at(0.25, 0, 0.2));
  small.drive(robot, 0.1, 0.1);
  small.run(6.0);
  EXPECT_GT(small.position(robot).x(), 0.5);
}

TEST(Planar, RobotsInACrowdNeverPassThroughEachOther) {
  SmallWorld small(planar.world());
  std::vector<BodyId> robots;
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

TEST(Planar, ACollisionOfDiscsConservesMomentum) {
  SmallWorld small(planar.world(0.0));
  const description::Surface bouncy{0.5, 0.9};
  const auto one = small.add(disc(1.0, 0.05, bouncy), at(-0.5, 0, 0.02));
  const auto two = small.add(disc(3.0, 0.05, bouncy), at(0, 0.03, 0.02));
  small.world().set_root_twist(one, {Vector3d(0, 0, 3), Vector3d(1, 0, 0)});
  const auto angular_momentum = [&] {
    double sum = 0.0;
    for (const auto& [body, mass] : {std::pair{one, 1.0}, std::pair{two, 3.0}}) {
      sum += mass * small.position(body).cross(small.velocity(body)).z();
      sum += 0.5 * mass * 0.05 * 0.05 * small.world().link_twist(body, LinkId{0}).angular_W.z();
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

TEST(Planar, DiscsBounceWithTheirRestitution) {
  SmallWorld small(planar.world(0.0));
  const description::Surface bouncy{0.0, 0.8};
  const auto one = small.add(disc(1.0, 0.05, bouncy), at(-0.5, 0, 0.02));
  const auto two = small.add(disc(1.0, 0.05, {0.0, 1.0}), at(0, 0, 0.02));
  small.world().set_root_twist(one, {Vector3d::Zero(), Vector3d(1, 0, 0)});
  small.run(1.0);
  EXPECT_NEAR(small.velocity(one).x(), 0.1, 1e-6);
  EXPECT_NEAR(small.velocity(two).x(), 0.9, 1e-6);
}

TEST(Planar, FrictionStopsASlidingPuck) {
  for (const double direction : {0.0, 0.7, 2.0}) {
    SmallWorld small(planar.world(0.3));
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
  SmallWorld small(planar.world(0.3));
  const auto puck = small.add(disc(0.5, 0.04), at(0, 0, 0.02));
  small.world().set_root_twist(puck, {Vector3d(0, 0, 5), Vector3d::Zero()});
  // The torque 2/3 mu m g r on the inertia m r^2 / 2 stops it after w r / (4/3 mu g).
  const double stops = 5.0 * 0.04 / (4.0 / 3.0 * 0.3 * g);
  small.run(0.5 * stops);
  EXPECT_NEAR(small.world().link_twist(puck, LinkId{0}).angular_W.z(), 2.5, 0.5);
  small.run(0.5 * stops + 0.02);
  EXPECT_EQ(small.world().link_twist(puck, LinkId{0}).angular_W.z(), 0.0);
}

TEST(Planar, APairOfMaterialsHasItsOwnFriction) {
  SmallWorld small(planar.world());
  small.description.materials = {"", "ice", "felt"};
  small.description.material_pairs = {{1, 2, 0.1, 0.0, 0.0}};
  small.description.models.edit(0).links[0].collisions[0].surface.material = 1;
  description::Surface felt;
  felt.material = 2;
  const auto puck = small.add(disc(0.5, 0.04, felt), at(0, 0, 0.02));
  small.world().set_root_twist(puck, {Vector3d::Zero(), Vector3d(0.5, 0, 0)});
  small.run(1.0);
  EXPECT_NEAR(small.position(puck).x(), 0.25 / (2.0 * 0.1 * g), 0.003);
}

TEST(Planar, ARobotPushesALooseBox) {
  SmallWorld small(planar.world(0.3));
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  const auto loose_box = small.add(box(0.3, {0.1, 0.1, 0.1}), at(0.15, 0, 0.05));
  small.drive(robot, 0.1, 0.1);
  small.run(4.0);
  EXPECT_GT(small.position(loose_box).x(), 0.4);
  EXPECT_NEAR(small.position(loose_box).x() - small.position(robot).x(), 0.05 + 0.058, 1e-3);
  EXPECT_NEAR(small.velocity(loose_box).x(), 0.1, 0.002);
}

TEST(Planar, ABoxPushedAtItsEdgeTurns) {
  SmallWorld small(planar.world(0.3));
  const auto robot = small.add(tracked_robot(), at(0, 0.06, 0));
  const auto loose_box = small.add(box(0.3, {0.1, 0.2, 0.1}), at(0.15, 0, 0.05));
  small.drive(robot, 0.1, 0.1);
  small.run(1.5);
  EXPECT_LT(heading(small, loose_box), -0.1);
}

TEST(Planar, BoxesPushedAgainstAWallDoNotEnterIt) {
  SmallWorld small(planar.world(0.1));
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
    SmallWorld small(planar.world(0.3));
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
  SmallWorld small(planar.world());
  const auto robot = small.add(model, at(0, 0, 0, 0.3));
  small.world().set_joint_target(robot, JointId{0}, physics::JointTarget::velocity(0.5));
  small.run(1.0);
  EXPECT_NEAR(small.world().joint_state(robot, JointId{0}).position, 0.5, 1e-9);
  EXPECT_EQ(small.world().joint_state(robot, JointId{0}).velocity, 0.5);
  EXPECT_NEAR(small.world().link_twist(robot, LinkId{turret}).angular_W.z(), 0.5, 1e-9);
  const Vector3d forward = small.world().link_pose(robot, LinkId{turret}).orientation * Vector3d::UnitX();
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), 0.8, 1e-9);
  small.run(2.0);
  EXPECT_NEAR(small.world().joint_state(robot, JointId{0}).position, 1.0, 1e-9);
  EXPECT_EQ(small.world().joint_state(robot, JointId{0}).velocity, 0.0);
}

TEST(Planar, AnArmOnATurretSweepsLooseObjectsAway) {
  description::Model model = tracked_robot();
  model.links[turret].collisions.push_back({"arm", {{0.1, 0, 0.02}}, Box{{0.1, 0.02, 0.02}}, {0.3, 0}});
  SmallWorld small(planar.world(0.3));
  const auto robot = small.add(model, at(0, 0, 0));
  const auto post =
      small.add(loose("post", Cylinder{0.02, 0.2}, solid_cylinder(0.05, 0.02, 0.2, 0.0)), at(0.08, 0.1, 0.1));
  small.world().set_joint_target(robot, JointId{0}, physics::JointTarget::velocity(1.0));
  small.run(2.0);
  EXPECT_LT(small.position(post).x(), 0.02) << "swept along";
  EXPECT_GT((small.position(post) - small.position(robot)).head<2>().norm(), 0.058 + 0.02 - 2e-3);
}

TEST(Planar, AgreesWithTheFullModelOnFreeGround) {
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

// Returns the message with which a world is rejected.
std::string refusal_of(const description::World& world) {
  WorkerPool workers(1);
  try {
    const std::unique_ptr<physics::World> refused = physics::make_world(world, workers);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Planar, RejectsUnsupportedModelsByName) {
  description::World leaning = planar.world();
  place(leaning, tracked_robot(), "robot", turned(0, 0, 0, Vector3d::UnitX(), 0.002));
  EXPECT_EQ(refusal_of(leaning), "model 'tracked_robot': planar physics requires upright robots");

  description::World slope = planar.world();
  slope.instances[0].X_WM = turned(0, 0, 0, Vector3d::UnitX(), 0.1);
  EXPECT_EQ(refusal_of(slope), "model 'floor': planar physics supports only horizontal and vertical planes");

  description::World moon = planar.world();
  moon.gravity = {0.0, 1.0, -1.6};
  EXPECT_EQ(refusal_of(moon), "planar physics requires gravity along -z");

  description::World door = planar.world();
  description::Model hinged = loose("door", Box{{1, 0.1, 1}}, solid_box(1, {1, 0.1, 1}));
  description::Joint hinge;
  hinge.type = description::JointType::revolute;
  hinge.parent = description::Joint::world;
  hinge.child = 0;
  hinged.joints.push_back(hinge);
  place(door, hinged, "door", at(0, 0, 0.5));
  EXPECT_EQ(refusal_of(door), "model 'door': planar physics does not support joints to the world that are not fixed");

  description::World hole = planar.world();
  hole.instances.clear();
  place(hole, tracked_robot(), "robot", at(0, 0, 0));
  EXPECT_EQ(refusal_of(hole), "model 'tracked_robot': planar physics requires ground under the model");
}

TEST(Planar, ABodyAddedWithoutGroundIsRejectedAndTheWorldContinues) {
  SmallWorld small(planar.world());
  small.description.models.clear();
  small.description.instances.clear();
  small.add(static_shape("table", Box{{2, 2, 0.1}}), at(0, 0, -0.05));
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  EXPECT_THROW(small.world().add_body(1, at(5, 0, 0)), std::invalid_argument);
  small.drive(robot, 0.1, 0.1);
  small.run(1.0);
  EXPECT_GT(small.position(robot).x(), 0.09);
}

TEST(Planar, ABodyFixedToTheWorldIsAnObstacle) {
  SmallWorld small(planar.world());
  description::Model post = loose("post", Box{{0.1, 0.1, 0.2}}, solid_box(1, {0.1, 0.1, 0.2}));
  description::Joint weld;
  weld.type = description::JointType::fixed;
  weld.parent = description::Joint::world;
  weld.child = 0;
  post.joints.push_back(weld);
  const auto fixed = small.add(post, at(0.25, 0, 0.1, 0.2));
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  const Vector3d before = small.position(fixed);
  small.drive(robot, 0.1, 0.1);
  small.run(2.0);
  EXPECT_EQ(small.position(fixed), before);
  EXPECT_LT(small.position(robot).x(), 0.15);
}

}  // namespace
}  // namespace cohort::test
