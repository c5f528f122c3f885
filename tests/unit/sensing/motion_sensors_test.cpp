// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/sensed.hpp"

/// Sensors that ask physics for accelerations and for what goes through joints, against closed forms.
namespace cohort {
namespace {

using namespace test;
using description::ForceTorqueSensor;
using description::Model;
using std::numbers::pi;

description::Imu imu(const Pose& X_LS = {}) {
  description::Imu result;
  result.name = "imu";
  result.X_LS = X_LS;
  return result;
}

void expect_near(const Eigen::Vector3d& value, const Eigen::Vector3d& expected, double tolerance) {
  EXPECT_LT((value - expected).norm(), tolerance) << value.transpose() << ", expected " << expected.transpose();
}

TEST(ImuSensor, AtRestMeasuresGravityUpwardsAndNoRotation) {
  Sensed sensed(imu(), at(0, 0, 0.1, 0.8));
  expect_near(sensed.vector("linear_acceleration"), {0, 0, g}, 1e-12);  // before the first step
  sensed.small.run(1.0);
  expect_near(sensed.vector("linear_acceleration"), {0, 0, g}, 1e-3);
  expect_near(sensed.vector("angular_velocity"), {0, 0, 0}, 1e-6);
}

TEST(ImuSensor, InFreeFallMeasuresNothing) {
  Sensed sensed(imu({{0.1, 0.2, 0.3}}), at(0, 0, 50));
  sensed.read();
  sensed.small.run(0.5);
  expect_near(sensed.vector("linear_acceleration"), {0, 0, 0}, 1e-9);
}

TEST(ImuSensor, DistributesGravityToItsAxesByItsInclination) {
  Sensed sensed(imu(turned(0, 0, 0, {1, 0, 0}, 0.3)), turned(0, 0, 1, {0, 0, 1}, 1.7));
  expect_near(sensed.vector("linear_acceleration"), {0, g * std::sin(0.3), g * std::cos(0.3)}, 1e-12);
}

TEST(ImuSensor, MeasuresTheCentripetalAccelerationAtItsPosition) {
  constexpr double w = 3.0, r = 0.4;
  Sensed sensed(imu({{r, 0, 0}}));
  sensed.small.description.gravity.setZero();
  sensed.read();
  sensed.small.world().set_root_twist(sensed.body, {{0, 0, w}, {0, 0, 0}});
  sensed.small.run(0.5);
  expect_near(sensed.vector("linear_acceleration"), {-w * w * r, 0, 0}, 1e-9);
  expect_near(sensed.vector("angular_velocity"), {0, 0, w}, 1e-12);
}

// Runs `check` with each dynamics, with steps of 10 and 1 ms, and turning in both directions.
template <class Check>
void in_every_way(const Model& model, const Check& check) {
  for (const auto dynamics : {description::Dynamics::bullet, description::Dynamics::cohort})
    for (const int step_ms : {10, 1})
      for (const double sense : {1.0, -1.0}) {
        SCOPED_TRACE(std::string(dynamics == description::Dynamics::bullet ? "bullet" : "cohort") + ", " +
                     std::to_string(step_ms) + " ms, sense " + std::to_string(sense));
        Sensed sensed(model, at(0, 0, 1));
        sensed.small.description.physics.dynamics = dynamics;
        sensed.small.description.step = std::chrono::milliseconds(step_ms);
        check(sensed, sense);
      }
}

// A balanced drum that turns about a horizontal axis at a constant rate, with a device on it.
Model drum(const description::Device& device) {
  Model model = carrier(device);
  model.joints.push_back(joint_of("hinge", description::JointType::revolute, description::Joint::world, 0, {0, 1, 0}));
  return model;
}

TEST(ImuSensor, MeasuresAlongTheRadiusAndGravityUpwardsWhileItTurns) {
  constexpr double w = 5.0, r = 0.3;
  in_every_way(drum(imu({{r, 0, 0}})), [](Sensed& sensed, double sense) {
    sensed.read();
    sensed.small.world().set_joint_state(sensed.body, JointId{0}, std::array{0.0}, std::array{w * sense});
    for (int i = 0; i < 50; ++i) {
      sensed.small.world().step();
      const Eigen::Quaterniond R_WS = sensed.small.world().link_pose(sensed.body, LinkId{0}).orientation;
      const Eigen::Vector3d up = R_WS.conjugate() * Eigen::Vector3d(0, 0, g);
      expect_near(sensed.vector("linear_acceleration"), up - Eigen::Vector3d(w * w * r, 0, 0), 1e-9);
    }
  });
}

TEST(ImuSensor, GivesAngularVelocityInItsOwnAxes) {
  Sensed sensed(imu(turned(0, 0, 0, {1, 0, 0}, 0.5 * pi)));
  sensed.small.world().set_root_twist(sensed.body, {{0.1, 0.2, 0.3}, {0, 0, 0}});
  expect_near(sensed.vector("angular_velocity"), {0.1, 0.3, -0.2}, 1e-12);
}

// Turned by `yaw` about z.
void expect_yaw(Sensed& sensed, double yaw) {
  EXPECT_NEAR(sensed.value("orientation", 0), 0.0, 1e-9);
  EXPECT_NEAR(sensed.value("orientation", 1), 0.0, 1e-9);
  EXPECT_NEAR(sensed.value("orientation", 2), std::sin(0.5 * yaw), 1e-9);
  EXPECT_NEAR(sensed.value("orientation", 3), std::cos(0.5 * yaw), 1e-9);
}

TEST(ImuSensor, GivesItsOrientationRelativeToTheInitialOne) {
  Sensed sensed(imu(), at(0, 0, 50, 0.7));
  expect_yaw(sensed, 0.0);
  sensed.small.world().set_root_twist(sensed.body, {{0, 0, 0.5}, {0, 0, 0}});
  sensed.small.run(1.0);
  expect_yaw(sensed, 0.5);
}

TEST(ImuSensor, GivesItsOrientationInTheRequestedFrame) {
  description::Imu in_world = imu();
  in_world.is_relative_to_world = true;
  Sensed sensed(in_world, at(0, 0, 1, 0.7));
  expect_yaw(sensed, 0.7);
  in_world.reference_rpy = {0, 0, 0.2};
  Sensed turned_frame(in_world, at(0, 0, 1, 0.7));
  expect_yaw(turned_frame, 0.5);
  in_world.is_relative_to_world = false;
  Sensed turned_from_first(in_world, at(0, 0, 1, 0.7));
  expect_yaw(turned_from_first, -0.2);
}

TEST(ImuSensor, WithoutOrientationHasNoChannelForIt) {
  description::Imu sensor = imu();
  sensor.has_orientation = false;
  Sensed sensed(sensor);
  ASSERT_EQ(sensed.channels().size(), 2u);
  expect_near(sensed.vector("linear_acceleration"), {0, 0, g}, 1e-12);
}

TEST(AccelerometerSensor, MeasuresGravityAlongItsAxesAndNothingInFreeFall) {
  const Pose X_LS = turned(0, 0, 0, {0, 1, 0}, 0.4);
  Sensed sensed(description::Accelerometer{"a", 0, X_LS}, at(0, 0, 50));
  expect_near(sensed.vector("acceleration"), {-g * std::sin(0.4), 0, g * std::cos(0.4)}, 1e-12);
  sensed.small.run(0.1);
  expect_near(sensed.vector("acceleration"), {0, 0, 0}, 1e-9);
}

// A bob of 2 kg, 0.3 m along x from the fixed joint that holds it. The joint is rotated about z in the bob, and the bob
// about z in the world.
Model hanging(ForceTorqueSensor sensor) {
  Model model;
  model.name = "hanging";
  model.links.push_back({"base", {}, solid_box(1.0, {0.1, 0.1, 0.1}), {}});
  description::Link bob{"bob", at(0, 0, 0, 0.5 * pi), solid_box(2.0, {0.1, 0.1, 0.1}), {}};
  bob.inertial.X_LI.position.x() = 0.3;
  model.links.push_back(bob);
  description::Joint to_world, joint;
  to_world.name = "to_world";
  to_world.parent = description::Joint::world;
  to_world.child = 0;
  joint.name = "joint";
  joint.parent = 0;
  joint.child = 1;
  joint.X_LJ = at(0, 0, 0, 0.5 * pi);
  model.joints = {to_world, joint};
  sensor.name = "wrench";
  sensor.joint = 1;
  model.devices.push_back(sensor);
  return model;
}

TEST(ForceTorqueSensor, MeasuresAHangingWeightInTheRequestedAxes) {
  using Frame = ForceTorqueSensor::Frame;
  constexpr double weight = 2.0 * g, moment = 0.3 * weight;
  // In the world the bob is 0.3 m along y: its weight turns it about -x. These are the axes of the parent.
  const auto check = [&](const ForceTorqueSensor& sensor, const Eigen::Vector3d& torque, double sign) {
    Sensed sensed(hanging(sensor), at(0, 0, 1));
    sensed.read();
    sensed.small.run(0.1);
    expect_near(sensed.vector("force"), {0, 0, -sign * weight}, 1e-6);
    expect_near(sensed.vector("torque"), sign * torque, 1e-6);
  };
  check({"", 0, {}, Frame::parent, true}, {-moment, 0, 0}, 1.0);
  check({"", 0, {}, Frame::parent, false}, {-moment, 0, 0}, -1.0);
  check({"", 0, {}, Frame::child, true}, {0, moment, 0}, 1.0);
  check({"", 0, {}, Frame::sensor, true}, {moment, 0, 0}, 1.0);                      // a quarter turn further
  check({"", 0, at(0, 0, 0, 0.5 * pi), Frame::sensor, true}, {0, -moment, 0}, 1.0);  // and one more
}

// A bob of 2 kg turns on a hinge, 0.3 m from its vertical axis; the base and the bob are the links of a fixed joint.
Model turning(ForceTorqueSensor sensor, std::size_t joint) {
  Model model = hanging({});
  model.joints[0].type = description::JointType::revolute;
  sensor.name = "wrench";
  sensor.joint = joint;
  model.devices = {sensor};
  return model;
}

TEST(ForceTorqueSensor, MeasuresACentrifugalForceAlongTheBoomInEveryAxes) {
  using Frame = ForceTorqueSensor::Frame;
  constexpr double w = 5.0, force = 2.0 * w * w * 0.3;
  const auto check = [&](const ForceTorqueSensor& sensor, std::size_t joint, const Eigen::Vector3d& outwards) {
    in_every_way(turning(sensor, joint), [&](Sensed& sensed, double sense) {
      sensed.small.description.gravity.setZero();
      sensed.read();
      sensed.small.world().set_joint_state(sensed.body, JointId{0}, std::array{0.0}, std::array{w * sense});
      sensed.small.run(0.2);
      expect_near(sensed.vector("force"), force * outwards, 1e-9 * force);
      expect_near(sensed.vector("torque"), {0, 0, 0}, 1e-9);
    });
  };
  // The bob is rotated by a quarter turn in the base, and the axes of the sensor by another one.
  check({"", 0, {}, Frame::child, true}, 1, {1, 0, 0});
  check({"", 0, {}, Frame::child, false}, 1, {-1, 0, 0});
  check({"", 0, {}, Frame::parent, true}, 1, {0, 1, 0});
  check({"", 0, {}, Frame::parent, false}, 1, {0, -1, 0});
  check({"", 0, {}, Frame::sensor, true}, 1, {0, -1, 0});
  check({"", 0, {}, Frame::child, true}, 0, {0, 1, 0});  // the hinge; its child is the base
}

TEST(ForceTorqueSensor, IsZeroWithoutLoadBeforeTheFirstStep) {
  Sensed sensed(hanging({}), at(0, 0, 1));
  EXPECT_EQ(sensed.vector("force"), Eigen::Vector3d::Zero().eval());
}

}  // namespace
}  // namespace cohort
