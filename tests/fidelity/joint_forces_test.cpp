// SPDX-License-Identifier: Apache-2.0

// Forces and torques through joints, compared with statics and dynamics computed by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/worlds/small_world.hpp"

namespace cohort::test {
namespace {

using description::Joint;
using description::JointType;
using Eigen::Vector3d;
using physics::Wrench;

description::Inertial mass_at(double mass, const Vector3d& p_LI) {
  description::Inertial inertial = solid_box(mass, {0.02, 0.03, 0.04});
  inertial.X_LI.position = p_LI;
  return inertial;
}

// A boom fixed to the world at its origin by a hinge about y or a weld, and a weight welded to its end.
constexpr double boom_mass = 0.2;
constexpr double weight_mass = 0.5;
constexpr double boom_length = 0.3;
description::Model crane(JointType hinge) {
  description::Model model;
  model.name = "crane";
  model.links.push_back({"boom", {}, mass_at(boom_mass, {0.5 * boom_length, 0, 0}), {}});
  model.links.push_back({"weight", {{boom_length, 0, 0}}, mass_at(weight_mass, Vector3d::Zero()), {}});
  model.joints.push_back(joint_of("hinge", hinge, Joint::world, 0, Vector3d::UnitY()));
  model.joints.push_back(joint_of("weld", JointType::fixed, 0, 1, Vector3d::UnitZ()));
  return model;
}

void expect_wrench(const Wrench& wrench, const Vector3d& force_W, const Vector3d& torque_W, double within) {
  EXPECT_LT((wrench.force_W - force_W).norm(), within) << "force " << wrench.force_W.transpose();
  EXPECT_LT((wrench.torque_W - torque_W).norm(), within) << "torque " << wrench.torque_W.transpose();
}

TEST(JointForces, AWeldCarriesAWeightAndItsMoment) {
  SmallWorld small(empty_world());
  const auto body = small.add(crane(JointType::fixed), at(1, 2, 3));
  small.world().record(body);
  small.run(0.05);
  expect_wrench(small.world().joint_wrench(body, JointId{1}), {0, 0, weight_mass * g}, Vector3d::Zero(), 1e-9);
  // The upward torque at x = l against a weight that pulls down is about -y.
  const double moment = (0.5 * boom_mass + weight_mass) * g * boom_length;
  expect_wrench(small.world().joint_wrench(body, JointId{0}), {0, 0, (boom_mass + weight_mass) * g}, {0, -moment, 0},
                1e-9);
}

TEST(JointForces, AMotorHoldsAnArmWithTheTorqueOfItsWeight) {
  SmallWorld small(empty_world());
  description::Model model = crane(JointType::revolute);
  model.devices.push_back(description::VelocityMotor{"motor", 0, 1.0, 10.0});
  const auto body = small.add(model, at(0, 0, 0));
  small.world().record(body);
  small.run(0.05);
  const double moment = (0.5 * boom_mass + weight_mass) * g * boom_length;
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).effort, -moment, 1e-6);
  expect_wrench(small.world().joint_wrench(body, JointId{0}), {0, 0, (boom_mass + weight_mass) * g}, {0, -moment, 0},
                1e-6);
}

TEST(JointForces, APushOnALinkLoadsTheJointsAboveIt) {
  SmallWorld small(empty_world());
  const auto body = small.add(crane(JointType::fixed), at(0, 0, 0));
  small.world().record(body);
  const Vector3d push(1.0, 2.0, -3.0);
  const Vector3d twist(0.1, -0.2, 0.3);
  small.world().push_body(body, LinkId{1}, {push, twist});
  small.world().step();
  const Vector3d weight(0, 0, -weight_mass * g);
  expect_wrench(small.world().joint_wrench(body, JointId{1}), -push - weight, -twist, 1e-9);
  const Vector3d boom(0, 0, -boom_mass * g);
  const Vector3d end(boom_length, 0, 0);
  expect_wrench(small.world().joint_wrench(body, JointId{0}), -push - weight - boom,
                -twist - end.cross(push + weight) - (0.5 * end).cross(boom), 1e-9);
  small.world().step();
  expect_wrench(small.world().joint_wrench(body, JointId{1}), -weight, Vector3d::Zero(), 1e-9);
}

// Runs `check` with each dynamics, with steps of 10 and 1 ms, and turning in both directions.
template <class Check>
void in_every_way(Check&& check) {
  for (const auto dynamics : {description::Dynamics::bullet, description::Dynamics::cohort})
    for (const int step_ms : {10, 1})
      for (const double sense : {1.0, -1.0}) {
        SCOPED_TRACE(std::string(dynamics == description::Dynamics::bullet ? "bullet" : "cohort") + ", " +
                     std::to_string(step_ms) + " ms, sense " + std::to_string(sense));
        SmallWorld small(empty_world());
        small.description.physics.dynamics = dynamics;
        small.description.step = std::chrono::milliseconds(step_ms);
        check(small, sense);
      }
}

TEST(JointForces, ARotatingMassIsPulledInwards) {
  in_every_way([](SmallWorld& small, double sense) {
    small.description.gravity.setZero();
    description::Model model = crane(JointType::revolute);
    model.joints[0].axis.direction = Vector3d::UnitZ();
    const auto body = small.add(model, at(0, 0, 0));
    small.world().record(body);
    const double rate = 5.0 * sense;
    small.world().set_joint_state(body, JointId{0}, std::array{0.0}, std::array{rate});
    small.run(0.3);
    const Vector3d outwards = small.world().link_pose(body, LinkId{1}).position.normalized();
    const Vector3d weld = -weight_mass * rate * rate * boom_length * outwards;
    expect_wrench(small.world().joint_wrench(body, JointId{1}), weld, Vector3d::Zero(), 1e-9 * weld.norm());
    const Wrench on_parent = small.world().joint_wrench_on_parent(body, JointId{1});
    expect_wrench(on_parent, -weld, Vector3d::Zero(), 1e-9 * weld.norm());
    const Vector3d hinge = -(weight_mass + 0.5 * boom_mass) * rate * rate * boom_length * outwards;
    expect_wrench(small.world().joint_wrench(body, JointId{0}), hinge, Vector3d::Zero(), 1e-9 * hinge.norm());
  });
}

// A bob on a swinging rod is pulled along the rod.
TEST(JointForces, APendulumPullsAlongItsRod) {
  in_every_way([](SmallWorld& small, double sense) {
    description::Model model = crane(JointType::revolute);
    model.links[0].inertial = mass_at(1e-6, Vector3d::Zero());
    model.links[0].inertial.inertia *= 1e-6;
    model.links[1].inertial.inertia *= 1e-9;
    const auto body = small.add(model, at(0, 0, 0));
    small.world().record(body);
    small.world().set_joint_state(body, JointId{0}, std::array{1.5}, std::array{4.0 * sense});
    for (int i = 0; i < 40; ++i) {
      small.world().step();
      const Vector3d along = small.world().link_pose(body, LinkId{1}).position.normalized();
      const Vector3d force_W = small.world().joint_wrench(body, JointId{1}).force_W;
      EXPECT_LT(force_W.cross(along).norm(), 1e-5 * force_W.norm()) << "at step " << i;
    }
  });
}

// The axle carries the weight of a balanced wheel, upwards in the vehicle's axes, at any speed.
TEST(JointForces, AFastWheelWeighsDownwardsOnItsAxle) {
  in_every_way([](SmallWorld& small, double sense) {
    description::Model model = crane(JointType::revolute);
    model.links[0].inertial = mass_at(boom_mass, Vector3d::Zero());
    model.links[1].X_ML = {};
    const auto body = small.add(model, at(0, 0, 0));
    small.world().record(body);
    small.world().set_joint_state(body, JointId{0}, std::array{0.0}, std::array{100.0 * sense});
    small.run(0.05);
    expect_wrench(small.world().joint_wrench_on_parent(body, JointId{0}), {0, 0, -(boom_mass + weight_mass) * g},
                  Vector3d::Zero(), 1e-9);
  });
}

// A swinging tree of every kind of joint, with motors, damping, springs and friction. The force through a joint along
// its axis is the sum of these, regardless of the motion.
TEST(JointForces, AlongItsAxisAJointTransmitsMotorSpringAndDamper) {
  SmallWorld small(empty_world());
  description::Model model;
  model.name = "tree";
  model.links.push_back({"root", {}, mass_at(1.0, {0.01, 0.02, 0}), {}});
  model.links.push_back({"turning", {{0.1, 0, 0}}, mass_at(0.4, {0.05, 0.02, 0.01}), {}});
  model.links.push_back({"sliding", {{0.2, 0, 0}}, mass_at(0.3, {0.03, 0, 0.05}), {}});
  model.links.push_back({"ball", {{-0.1, 0.1, 0}}, mass_at(0.2, {-0.05, 0.02, 0}), {}});
  model.joints.push_back(joint_of("hinge", JointType::revolute, 0, 1, Vector3d(0, 1, 1).normalized()));
  model.joints.push_back(joint_of("rail", JointType::prismatic, 1, 2, Vector3d::UnitX()));
  model.joints.push_back(joint_of("socket", JointType::ball, 0, 3, Vector3d::UnitX()));
  model.joints[0].axis.damping = 0.02;
  model.joints[1].axis.damping = 0.5;
  model.joints[1].axis.spring_stiffness = 30.0;
  model.devices.push_back(description::VelocityMotor{"motor", 0, 5.0, 0.05});
  const auto body = small.add(model, at(0, 0, 1));
  physics::World& world = small.world();
  world.record(body);
  world.set_root_twist(body, {Vector3d(1, -2, 3), Vector3d(0.1, 0.2, 0.3)});
  world.set_joint_state(body, JointId{1}, std::array{0.02}, std::array{0.3});
  world.set_joint_state(body, JointId{2}, std::array{0.0, 0.0, 0.0, 1.0}, std::array{1.0, -2.0, 1.5});
  world.set_joint_target(body, JointId{0}, physics::JointTarget::velocity(4.0));
  constexpr double h = 0.01;
  for (int i = 0; i < 50; ++i) {
    const double slide = world.joint_state(body, JointId{1}).position;
    const double rate_before = world.joint_state(body, JointId{1}).velocity;
    world.step();
    const Vector3d hinge_W = world.link_pose(body, LinkId{1}).orientation * model.joints[0].axis.direction;
    const Vector3d rail_W = world.link_pose(body, LinkId{2}).orientation * Vector3d::UnitX();
    const double turned_by =
        world.joint_state(body, JointId{0}).effort - 0.02 * world.joint_state(body, JointId{0}).velocity;
    EXPECT_NEAR(world.joint_wrench(body, JointId{0}).torque_W.dot(hinge_W), turned_by, 1e-9) << "at step " << i;
    const double rate = world.joint_state(body, JointId{1}).velocity;
    EXPECT_NEAR(world.joint_wrench(body, JointId{1}).force_W.dot(rail_W),
                -30.0 * (slide + 0.25 * h * (rate - rate_before)) - 0.5 * rate, 1e-9);
    EXPECT_LT(world.joint_wrench(body, JointId{2}).torque_W.norm(), 1e-9) << "a ball joint holds no torque";
  }
}

TEST(JointForces, LegsOnTheFloorCarryTheTable) {
  // A table of a top and two legs welded to it: each joint carries the leg's share less the leg's own weight.
  SmallWorld small;
  description::Model model;
  model.name = "table";
  model.links.push_back({"top", {{0, 0, 0.11}}, mass_at(1.0, Vector3d::Zero()), {}});
  for (const double x : {0.1, -0.1}) {
    model.links.push_back({"leg",
                           {{x, 0, 0.05}},
                           mass_at(0.1, Vector3d::Zero()),
                           {{"foot", {}, description::Box{{0.001, 0.2, 0.1}}, {1.0, 0}}}});
    model.joints.push_back(joint_of("weld", JointType::fixed, 0, model.links.size() - 1, Vector3d::UnitZ()));
  }
  const auto body = small.add(model, at(0, 0, 0));
  small.world().record(body);
  small.run(1.0);
  const double left = small.world().joint_wrench(body, JointId{0}).force_W.z();
  const double right = small.world().joint_wrench(body, JointId{1}).force_W.z();
  EXPECT_NEAR(left + right, -g, 1e-3) << "the top presses down on the legs";
  EXPECT_NEAR(left - right, 0.0, 0.1) << "on both alike, as far as their feet are thin";
}

TEST(JointForces, ATurretJointCarriesARobotOnTop) {
  SmallWorld small;
  const auto below = small.add(tracked_robot(), at(0, 0, 0));
  const auto above = small.add(loose("weight", description::Cylinder{0.04, 0.04}, solid_cylinder(0.5, 0.04, 0.04, 0.0)),
                               at(0, 0, 0.115));
  small.world().record(below);
  small.run(1.0);
  EXPECT_NEAR(small.position(above).z(), 0.115, 1e-3);
  EXPECT_NEAR(small.world().joint_wrench(below, JointId{0}).force_W.z(), (0.3 + 0.5) * g, 0.01);
}

// When the robot pulls at a wall, the turret's joint transmits the pull of the tracks.
TEST(JointForces, ATurretJointTransmitsThePullOfTheTracks) {
  for (const double turret_yaw : {0.0, 0.7}) {
    SmallWorld small;
    const auto robot = small.add(tracked_robot(), at(0, 0, 0, 0.4));
    small.world().record(robot);
    small.world().set_joint_state(robot, JointId{0}, std::array{turret_yaw}, std::array{0.0});
    small.world().connections().connect({robot, LinkId{1}}, {{0.06, 0, 0.02}}, {BodyId{0}, LinkId{0}});
    small.drive(robot, -0.2, -0.2);
    small.run(1.0);
    const double traction = small.world().device_state(robot, DeviceId{0}, 0).effort +
                            small.world().device_state(robot, DeviceId{0}, 1).effort;
    EXPECT_NEAR(traction, -2.0 * 0.02 / 0.022, 1e-6) << "both motors' torque over the radius of the wheels";
    const Pose X_WL = small.world().link_pose(robot, LinkId{0});
    const Vector3d on_turret_L = X_WL.orientation.conjugate() * small.world().joint_wrench(robot, JointId{0}).force_W;
    EXPECT_NEAR(on_turret_L.x(), traction, 0.01) << "with the turret at " << turret_yaw;
    EXPECT_NEAR(on_turret_L.y(), 0.0, 0.02);
  }
}

TEST(JointForces, AreZeroUnlessRecordedAndAfterRestore) {
  SmallWorld small(empty_world());
  const auto body = small.add(crane(JointType::fixed), at(0, 0, 0));
  small.run(0.02);
  EXPECT_EQ(small.world().joint_wrench(body, JointId{0}).force_W, Vector3d::Zero());
  small.world().record(body);
  EXPECT_EQ(small.world().joint_wrench(body, JointId{0}).force_W, Vector3d::Zero()) << "before the next step";
  small.run(0.01);
  EXPECT_GT(small.world().joint_wrench(body, JointId{0}).force_W.z(), 1.0);

  WorkerPool workers(1);
  const std::unique_ptr<physics::World> restored = physics::make_world(small.description, workers);
  restored->record(body);
  restore_from(small.world(), *restored);
  EXPECT_EQ(restored->joint_wrench(body, JointId{0}).force_W, Vector3d::Zero());
  restored->step();
  small.world().step();
  EXPECT_EQ(restored->joint_wrench(body, JointId{0}).force_W, small.world().joint_wrench(body, JointId{0}).force_W);
  restored->set_present(body, false);
  EXPECT_EQ(restored->joint_wrench(body, JointId{0}).force_W, Vector3d::Zero());
}

TEST(Acceleration, IsGravityInFreeFallAndZeroAtRest) {
  SmallWorld small;
  const auto falling = small.add(loose("ball", description::Sphere{0.05}, solid_sphere(0.2, 0.05)), at(1, 0, 5));
  const auto resting = small.add(tracked_robot(), at(0, 0, 0));
  for (const auto body : {falling, resting}) small.world().record(body);
  small.run(0.5);
  EXPECT_LT((small.world().link_acceleration(falling, LinkId{0}, {0.01, 0, 0}) - Vector3d(0, 0, -g)).norm(), 1e-9);
  EXPECT_LT(small.world().link_acceleration(resting, LinkId{1}, {0.01, 0, 0.03}).norm(), 1e-6);
}

TEST(Acceleration, OfARotatingPointIsCentripetal) {
  for (const description::Fidelity fidelity : {description::Fidelity::treel, description::Fidelity::planar}) {
    SmallWorld small;
    small.description.physics.fidelity = fidelity;
    const auto robot = small.add(tracked_robot(), at(0, 0, 0));
    small.world().record(robot);
    small.drive(robot, -0.06, 0.06);
    small.run(2.0);
    const double rate = small.world().link_twist(robot, LinkId{0}).angular_W.z();
    EXPECT_NEAR(rate, 0.12 / 0.08, 0.02);
    const Vector3d p_LP(0.1, 0, 0.02);
    const Pose X_WL = small.world().link_pose(robot, LinkId{0});
    const Vector3d acceleration = small.world().link_acceleration(robot, LinkId{0}, p_LP);
    EXPECT_NEAR(acceleration.norm(), rate * rate * 0.1, 1e-3);
    const Vector3d direction_L = (X_WL.orientation.conjugate() * acceleration).normalized();
    EXPECT_LT(direction_L.x(), -0.999);
    EXPECT_NEAR(direction_L.y(), 0.0, 1e-3) << "half a step's turn would be 0.0075";
  }
}

// A boom turns about a vertical hinge, and on its end an arm that turns about another one.
TEST(Acceleration, IsThatOfTheEndOfTheStepAlsoOfLinksThatTurnOnOthers) {
  in_every_way([](SmallWorld& small, double sense) {
    small.description.gravity.setZero();
    constexpr double arm_length = 0.2;
    description::Model model;
    model.name = "arms";
    model.links.push_back({"boom", {}, mass_at(1.0, Vector3d::Zero()), {}});
    model.links.push_back({"arm", {{boom_length, 0, 0}}, mass_at(1.0, Vector3d::Zero()), {}});
    model.joints.push_back(joint_of("shoulder", JointType::revolute, Joint::world, 0, Vector3d::UnitZ()));
    model.joints.push_back(joint_of("elbow", JointType::revolute, 0, 1, Vector3d::UnitZ()));
    const auto body = small.add(model, at(1, 2, 3));
    small.world().record(body);
    const double shoulder = 4.0 * sense;
    const double elbow = 3.0 * sense;
    small.world().set_joint_state(body, JointId{0}, std::array{0.3}, std::array{shoulder});
    small.world().set_joint_state(body, JointId{1}, std::array{0.4}, std::array{elbow});
    for (int i = 0; i < 30; ++i) {
      small.world().step();
      const Vector3d boom_W = small.world().link_pose(body, LinkId{0}).orientation * Vector3d::UnitX();
      const Vector3d arm_W = small.world().link_pose(body, LinkId{1}).orientation * Vector3d::UnitX();
      const double both = shoulder + elbow;
      const Vector3d expected = -shoulder * shoulder * boom_length * boom_W - both * both * arm_length * arm_W;
      const Vector3d value = small.world().link_acceleration(body, LinkId{1}, {arm_length, 0, 0});
      EXPECT_LT((value - expected).norm(), 1e-9 * expected.norm()) << "at step " << i;
    }
  });
}

TEST(Acceleration, OfATumblingBodyInFreeFallPointsToItsCentre) {
  in_every_way([](SmallWorld& small, double sense) {
    const Vector3d centre(0.02, 0, 0);
    description::Inertial inertial = solid_sphere(0.5, 0.1);
    inertial.X_LI.position = centre;
    const auto body = small.add(loose("ball", description::Sphere{0.1}, inertial), at(0, 0, 50));
    small.world().record(body);
    const double rate = 6.0 * sense;
    small.world().set_root_twist(body, {{0, rate, 0}, {0.3, 0, 0}});
    small.run(0.2);
    const Vector3d arm_W = small.world().link_pose(body, LinkId{0}).orientation * Vector3d(0.05, 0, 0);
    const Vector3d gravity(0, 0, -g);
    EXPECT_LT((small.world().link_acceleration(body, LinkId{0}, centre) - gravity).norm(), 1e-9);
    EXPECT_LT((small.world().link_acceleration(body, LinkId{0}, centre + Vector3d(0.05, 0, 0)) -
               (gravity - rate * rate * arm_W))
                  .norm(),
              1e-9);
  });
}

}  // namespace
}  // namespace cohort::test
