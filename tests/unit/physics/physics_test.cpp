// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <stdexcept>

#include "server/physics/islands/islands.hpp"
#include "server/physics/make_world.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/worlds/small_world.hpp"

namespace cohort::physics {
namespace {

using namespace test;

constexpr DeviceId drive{0};  // the tracked robot's drive

struct Drive {
  double left;
  double right;
};

void command(World& world, BodyId body, Drive tracks) {
  world.set_device_target(body, drive, 0, tracks.left);
  world.set_device_target(body, drive, 1, tracks.right);
}

void run(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step();
}

double yaw_of(const Pose& pose) {
  const Eigen::Vector3d x = pose.orientation * Eigen::Vector3d::UnitX();
  return std::atan2(x.y(), x.x());
}

template <class Body, class Part>
concept has_link = requires(const World& world, Body body, Part part) {
  world.link_pose(body, part);
};
template <class Body, class Part>
concept has_joint = requires(const World& world, Body body, Part part) {
  world.joint_state(body, part);
};

TEST(World, DistinguishesLinksFromJoints) {
  static_assert(has_link<BodyId, LinkId> && has_joint<BodyId, JointId>);
  static_assert(!has_link<BodyId, JointId> && !has_joint<BodyId, LinkId>);
  static_assert(!has_link<RobotId, LinkId> && !has_link<LinkId, BodyId> && !has_link<std::uint32_t, std::size_t>);
}

TEST(World, RejectsAnUnknownOutputOfADevice) {
  using enum description::Fidelity;
  for (const description::Fidelity fidelity : {treel, articulated, planar}) {
    SmallWorld small;
    small.description.physics.fidelity = fidelity;
    const BodyId body = small.add(tracked_robot(), {{0, 0, 0}});
    EXPECT_THROW(small.world().device_state(body, drive, 2), std::out_of_range);
    EXPECT_THROW(small.world().set_device_target(body, drive, 2, 0.1), std::out_of_range);
    EXPECT_THROW(small.world().device_state(body, DeviceId{1000}, 0), std::out_of_range);
  }
}

TEST(TreelDrive, StandsStillWhenCommanded) {
  description::World description = world_with_floor();
  const BodyId body{place(description, tracked_robot(), "robot", at(0, 0, 0, 0.3))};
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  run(*world, 100);
  const Pose settled = world->link_pose(body, LinkId{0});
  run(*world, 500);
  const Pose later = world->link_pose(body, LinkId{0});
  EXPECT_LT((later.position - settled.position).norm(), 0.4e-3) << "creep in 5 s";
  EXPECT_NEAR(later.position.z(), 0.0, 1e-3);
}

TEST(TreelDrive, ReachesTheCommandedVelocityWithinHalfAPercent) {
  description::World description = world_with_floor();
  const BodyId body{place(description, tracked_robot(), "robot", at(0, 0, 0))};
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  command(*world, body, {0.1, 0.1});
  run(*world, 200);
  const double before = world->link_pose(body, LinkId{0}).position.x();
  run(*world, 100);
  EXPECT_NEAR(world->link_pose(body, LinkId{0}).position.x() - before, 0.1, 0.0005);
  EXPECT_NEAR(world->device_state(body, drive, 0).velocity, 0.1, 0.0005);
}

TEST(TreelDrive, TurnsOnTheSpotAtTheRateOfItsGauge) {
  description::World description = world_with_floor();
  const BodyId body{place(description, tracked_robot(), "robot", at(0, 0, 0))};
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  command(*world, body, {-0.04, 0.04});  // 0.08 m/s over a gauge of 0.08 m: 1 rad/s
  run(*world, 100);
  const double before = yaw_of(world->link_pose(body, LinkId{0}));
  run(*world, 100);
  EXPECT_NEAR(yaw_of(world->link_pose(body, LinkId{0})) - before, 1.0, 0.01);
  EXPECT_LT(world->link_pose(body, LinkId{0}).position.head<2>().norm(), 0.002);
}

TEST(TreelDrive, IsStoppedByAWallAndStaysUpright) {
  description::World description = world_with_floor();
  const BodyId body{place(description, tracked_robot(), "robot", at(0, 0, 0))};
  place(description, static_shape("wall", description::Box{{0.1, 2.0, 0.3}}, {0.3, 0.0}), "wall", at(0.25, 0, 0.15));
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  command(*world, body, {0.2, 0.2});
  run(*world, 300);
  const Pose pose = world->link_pose(body, LinkId{0});
  EXPECT_NEAR(pose.position.x(), 0.2 - 0.058, 0.002);
  EXPECT_GT((pose.orientation * Eigen::Vector3d::UnitZ()).z(), 0.99);
  EXPECT_FALSE(world->contacts().empty());
}

TEST(TreelDrive, PushesWithAtMostTheForceOfItsMotors) {
  description::World description = world_with_floor();
  const BodyId body{place(description, tracked_robot(), "robot", at(0, 0, 0))};
  place(description, static_shape("wall", description::Box{{0.1, 2.0, 0.3}}, {0.0, 0.0}), "wall", at(0.25, 0, 0.15));
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  command(*world, body, {0.2, 0.2});
  run(*world, 120);  // against the wall, and not yet turned along it
  // The torque over the wheel radius: 0.02 N m / 0.022 m for each side.
  EXPECT_NEAR(world->device_state(body, drive, 0).effort, 0.02 / 0.022, 0.01);
  double momentum = 0.0;
  for (int i = 0; i < 50; ++i) {
    world->step();
    for (const Contact& contact : world->contacts())
      if (contact.body_a == body) momentum += contact.impulse;
  }
  EXPECT_NEAR(momentum / 0.5, 2.0 * 0.02 / 0.022, 0.04) << "mean force on the wall over 0.5 s";
}

TEST(TreelDrive, SlipsIfFrictionIsLessThanItsMotorForce) {
  description::World description = world_with_floor(0.05);
  const BodyId body{place(description, tracked_robot(), "robot", at(0, 0, 0))};
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  run(*world, 50);
  command(*world, body, {0.2, 0.2});
  world->step();
  const Twist before = world->link_twist(body, LinkId{0});
  run(*world, 10);
  // a = mu g while the tracks slip; encoders measure the tracks, not the ground.
  EXPECT_NEAR((world->link_twist(body, LinkId{0}).linear_W.x() - before.linear_W.x()) / 0.1, 0.05 * 9.81, 0.03);
  EXPECT_EQ(world->device_state(body, drive, 0).velocity, 0.2);
}

TEST(TreelDrive, DrivesOnTopOfABoxAndStandsOnIt) {
  description::World description = world_with_floor();
  const BodyId body{place(description, tracked_robot(), "robot", at(0, 0, 0.2))};
  place(description, static_shape("table", description::Box{{1.0, 1.0, 0.2}}), "table", at(0, 0, 0.1));
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  run(*world, 100);
  EXPECT_NEAR(world->link_pose(body, LinkId{0}).position.z(), 0.2, 1e-3);
  command(*world, body, {0.1, 0.1});
  run(*world, 200);
  EXPECT_NEAR(world->link_pose(body, LinkId{0}).position.x(), 0.2, 0.01);
  EXPECT_NEAR(world->link_pose(body, LinkId{0}).position.z(), 0.2, 1e-3);
}

TEST(TreelDrive, FallsOffAnEdgeOntoTheFloor) {
  description::World description = world_with_floor();
  const BodyId body{place(description, tracked_robot(), "robot", at(0.35, 0, 0.1))};
  place(description, static_shape("table", description::Box{{1.0, 1.0, 0.1}}), "table", at(0, 0, 0.05));
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  command(*world, body, {0.2, 0.2});
  run(*world, 500);
  const Pose pose = world->link_pose(body, LinkId{0});
  EXPECT_GT(pose.position.x(), 0.5);
  EXPECT_GT(pose.position.z(), -0.01) << "it sank";
  EXPECT_LT(pose.position.z(), 0.12);
}

TEST(JointMotor, TurnsTheTurretAtTheCommandedRate) {
  description::World description = world_with_floor();
  const BodyId body{place(description, tracked_robot(), "robot", at(0, 0, 0))};
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  world->set_joint_target(body, JointId{0}, JointTarget::velocity(1.2));
  run(*world, 50);
  const double before = world->joint_state(body, JointId{0}).position;
  run(*world, 100);
  EXPECT_NEAR(world->joint_state(body, JointId{0}).position - before, 1.2, 0.006);
  EXPECT_NEAR(world->joint_state(body, JointId{0}).velocity, 1.2, 0.006);
  const double yaw = yaw_of(world->link_pose(body, LinkId{1})) - yaw_of(world->link_pose(body, LinkId{0}));
  EXPECT_NEAR(std::remainder(yaw - world->joint_state(body, JointId{0}).position, 2 * M_PI), 0.0, 1e-9);
}

TEST(World, AcceleratesAFallingBodyByGravity) {
  description::World description = world_with_floor();
  description::Model ball;
  ball.name = "ball";
  ball.links.push_back({"link", {}, {}, {{"c", {}, description::Sphere{0.05}, {}}}});
  const BodyId body{place(description, ball, "ball", at(0, 0, 10.0))};
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  run(*world, 100);
  // Semi-implicit Euler: z0 - g h^2 n (n + 1) / 2.
  EXPECT_NEAR(world->link_pose(body, LinkId{0}).position.z(), 10.0 - 9.81 * 1e-4 * 100 * 101 / 2, 1e-9);
  EXPECT_NEAR(world->link_twist(body, LinkId{0}).linear_W.z(), -9.81, 1e-9);
}

TEST(World, KeepsRobotsFromPassingThroughEachOther) {
  description::World description = world_with_floor();
  const BodyId first{place(description, tracked_robot(), "first", at(-0.2, 0, 0, 0))};
  const BodyId second{place(description, tracked_robot(), "second", at(0.2, 0.01, 0, M_PI))};
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  command(*world, first, {0.2, 0.2});
  command(*world, second, {0.2, 0.2});
  for (int i = 0; i < 400; ++i) {
    world->step();
    const double apart =
        (world->link_pose(first, LinkId{0}).position - world->link_pose(second, LinkId{0}).position).head<2>().norm();
    ASSERT_GT(apart, 2 * 0.058 - 0.002) << "at step " << i;
  }
}

TEST(World, HoldsAJointAtItsLimit) {
  description::World description;
  description::Model arm;
  arm.name = "arm";
  arm.links.push_back({"base", {}, solid_cylinder(1000.0, 1.0, 1.0, 0.0), {}});
  arm.links.push_back({"rod", {{0, 0, 0}}, solid_cylinder(0.1, 0.01, 0.1, -0.1), {}});
  description::Joint hinge;
  hinge.name = "hinge";
  hinge.type = description::JointType::revolute;
  hinge.child = 1;
  hinge.axis.direction = Eigen::Vector3d::UnitY();
  hinge.axis.lower = -0.5;
  hinge.axis.upper = 0.5;
  arm.joints.push_back(hinge);
  arm.devices.push_back(description::VelocityMotor{"hinge", 0, 10.0, 5.0});
  const BodyId body{place(description, arm, "arm", at(0, 0, 0))};
  description.gravity = Eigen::Vector3d::Zero();
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  world->set_joint_target(body, JointId{0}, JointTarget::velocity(1.0));
  run(*world, 200);
  EXPECT_NEAR(world->joint_state(body, JointId{0}).position, 0.5, 0.02);
}

TEST(World, RotatesAnInertiaIntoItsPrincipalAxes) {
  description::World description;
  description.gravity = Eigen::Vector3d::Zero();
  description::Model body;
  body.name = "body";
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  description::Inertial inertial;
  inertial.inertia = R * Eigen::Vector3d(0.1, 0.2, 0.25).asDiagonal() * R.transpose();
  inertial.X_LI.position = {0.1, -0.2, 0.3};
  body.links.push_back({"link", {}, inertial, {}});
  const Pose X_WM = at(1, 2, 3, 0.4);
  const BodyId index{place(description, body, "body", X_WM)};
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  run(*world, 1);
  EXPECT_LT((world->link_pose(index, LinkId{0}).position - X_WM.position).norm(), 1e-12);
  EXPECT_LT(world->link_pose(index, LinkId{0}).orientation.angularDistance(X_WM.orientation), 1e-7);
}

TEST(Islands, ContainLinkedMembersInTheOrderOfTheLowest) {
  Islands islands;
  islands.reset(8);
  islands.link(5, 1);
  islands.link(3, 4);
  islands.link(1, 7);
  islands.finish();
  std::vector<std::vector<std::uint32_t>> found;
  for (std::uint32_t island = 0; island < islands.count(); ++island) {
    const auto members = islands.members(island);
    found.emplace_back(members.begin(), members.end());
  }
  EXPECT_EQ(found, (std::vector<std::vector<std::uint32_t>>{{0}, {1, 5, 7}, {2}, {3, 4}, {6}}));
}

}  // namespace
}  // namespace cohort::physics
