// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/robots/drive.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace cohort::ros2 {
namespace {

using std::numbers::pi;

constexpr double inf = std::numeric_limits<double>::infinity();

ChannelInfo channel(const std::string& name, std::uint32_t offset, double lower = -inf, double upper = inf) {
  ChannelInfo info;
  info.name = name;
  info.offset = offset;
  info.lower = lower;
  info.upper = upper;
  return info;
}

// Adds a wheel at y with a velocity motor and an encoder; `up` is the y component of its axis.
void add_wheel(description::Model& model, const std::string& name, double y, double radius, double up = 1.0) {
  const std::size_t joint = model.joints.size();
  description::Link wheel;
  wheel.name = name;
  wheel.X_ML.position = {0.0, y, radius};
  wheel.collisions.push_back({});
  wheel.collisions.back().shape = description::Cylinder{radius, 0.02};
  model.links.push_back(wheel);
  description::Joint axle;
  axle.name = name;
  axle.type = description::JointType::revolute;
  axle.child = model.links.size() - 1;
  axle.axis.direction = {0.0, up, 0.0};
  model.joints.push_back(axle);
  description::VelocityMotor motor;
  motor.name = name;
  motor.joint = joint;
  model.devices.emplace_back(motor);
  model.devices.emplace_back(description::JointEncoder{name, joint});
}

// Two wheels of radius 0.05 m that are 0.4 m apart. The right one turns backwards if its axis points to the right.
struct TwoWheels {
  explicit TwoWheels(double right_up = 1.0, double fastest = 10.0) {
    model.name = "two_wheels";
    model.links.resize(1);
    add_wheel(model, "left", 0.2, 0.05);
    add_wheel(model, "right", -0.2, 0.05, right_up);
    robot.command_channels = {channel("left/0/velocity", 0, -fastest, fastest),
                              channel("right/0/velocity", 1, -fastest, fastest)};
    robot.observation_channels = {channel("left/0/position", 0), channel("right/0/position", 1)};
  }
  Drive drive() const { return Drive::of(model, robot, {}).value(); }

  description::Model model;
  Start robot;
};

std::vector<double> commanded(const Drive& drive, const BodyVelocity& velocity, std::size_t channels = 2) {
  std::vector<double> command(channels, 99.0);
  drive.command(velocity, command);
  return command;
}

void expect_near(const std::vector<double>& values, const std::vector<double>& expected) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], expected[i], 1e-12) << i;
}

TEST(Ros2Drive, WheelsTurnForwardsForTheWayAndAgainstEachOtherForTheTurn) {
  const Drive drive = TwoWheels().drive();
  expect_near(commanded(drive, {0.1, 0.0}), {2.0, 2.0});
  expect_near(commanded(drive, {0.0, 0.5}), {-2.0, 2.0});
  expect_near(commanded(drive, {0.1, 0.5}), {0.0, 4.0});
}

TEST(Ros2Drive, AWheelWhoseAxisPointsToTheRightTurnsBackwards) {
  Drive drive = TwoWheels(-1.0).drive();
  expect_near(commanded(drive, {0.1, 0.5}), {0.0, -4.0});
  drive.measure(std::vector<double>{0.0, 0.0}, 0.0);
  EXPECT_NEAR(drive.measure(std::vector<double>{2.0, -2.0}, 1.0).x, 0.1, 1e-12);
}

TEST(Ros2Drive, ARobotThatIsTooSlowStaysOnItsArc) {
  const Drive drive = TwoWheels(1.0, 5.0).drive();
  expect_near(commanded(drive, {0.4, 0.5}), {3.0, 5.0});      // 6 and 10 are meant
  expect_near(commanded(drive, {-0.4, -0.5}), {-3.0, -5.0});  // the same backwards
}

TEST(Ros2Drive, TheSlowestWheelDecidesForAll) {
  TwoWheels robot;
  robot.robot.command_channels[1].upper = 5.0;
  expect_near(commanded(robot.drive(), {0.4, 0.5}), {3.0, 5.0});          // 6 and 10 are meant
  expect_near(commanded(robot.drive(), {0.4, -0.5}), {25.0 / 3.0, 5.0});  // 10 and 6 are meant
}

TEST(Ros2Drive, AChannelWithoutAReverseStandsStill) {
  TwoWheels robot;
  for (ChannelInfo& each : robot.robot.command_channels) each.lower = 0.0;
  expect_near(commanded(robot.drive(), {0.0, 0.5}), {0.0, 2.0});
}

TEST(Ros2Drive, EncodersMeasureAStraightPathATurnInPlaceAndAnArc) {
  Drive drive = TwoWheels().drive();
  ASSERT_TRUE(drive.measures());
  PlanarMotion motion = drive.measure(std::vector<double>{7.0, -3.0}, 0.0);
  EXPECT_EQ(motion.x, 0.0);
  EXPECT_EQ(motion.velocity.linear, 0.0);
  motion = drive.measure(std::vector<double>{9.0, -1.0}, 0.5);  // 0.1 m
  EXPECT_NEAR(motion.x, 0.1, 1e-12);
  EXPECT_NEAR(motion.heading, 0.0, 1e-12);
  EXPECT_NEAR(motion.velocity.linear, 0.2, 1e-12);
  motion = drive.measure(std::vector<double>{9.0 - 2.0 * pi, -1.0 + 2.0 * pi}, 0.5);  // 90 degrees to the left
  EXPECT_NEAR(motion.x, 0.1, 1e-12);
  EXPECT_NEAR(motion.heading, pi / 2, 1e-12);
  EXPECT_NEAR(motion.velocity.linear, 0.0, 1e-12);
  EXPECT_NEAR(motion.velocity.angular, pi, 1e-12);
  // A quarter of a circle of 1 m to the right, in small steps.
  const double left = 1.2 * pi / 2 / 0.05, right = 0.8 * pi / 2 / 0.05;
  constexpr int steps = 1000;
  for (int i = 1; i <= steps; ++i)
    motion = drive.measure(std::vector<double>{9.0 - 2.0 * pi + left * i / steps, -1.0 + 2.0 * pi + right * i / steps},
                           0.01);
  EXPECT_NEAR(motion.heading, 0.0, 1e-9);
  EXPECT_NEAR(motion.x, 1.1, 1e-6);
  EXPECT_NEAR(motion.y, 1.0, 1e-6);
  drive.restart();
  motion = drive.measure(std::vector<double>{50.0, 50.0}, 0.01);
  EXPECT_EQ(motion.x, 0.0);
  EXPECT_EQ(motion.y, 0.0);
  EXPECT_EQ(motion.velocity.linear, 0.0);
}

// Along an S of two arcs, compared with many runs whose encoders have other errors.
TEST(Ros2Drive, OdometryHasTheCovarianceThatTheNoiseOfItsEncodersCauses) {
  constexpr int runs = 4000, steps = 40;
  constexpr double deviation = 0.02, seconds = 0.05;  // [rad], [s]
  TwoWheels robot;
  for (description::Device& device : robot.model.devices)
    if (auto* const encoder = std::get_if<description::JointEncoder>(&device)) {
      encoder->readout.noises.push_back({.quantity = "position", .deviation = deviation, .bias_deviation = 1.0});
      encoder->readout.noises.push_back({.quantity = "velocity", .deviation = 100.0});
    }
  std::mt19937 random(1);
  std::normal_distribution<double> error(0.0, deviation);
  Eigen::Matrix<double, 5, 1> sum = Eigen::Matrix<double, 5, 1>::Zero();
  Eigen::Matrix<double, 5, 5> squares = Eigen::Matrix<double, 5, 5>::Zero();
  PlanarMotion motion;
  for (int run = 0; run < runs; ++run) {
    Drive drive = robot.drive();
    double left = 3.0, right = 3.0;
    for (int step = 0; step <= steps; ++step) {
      motion = drive.measure(std::vector<double>{left + error(random), right + error(random)}, seconds);
      left += step < steps / 2 ? 0.5 : 0.8;
      right += step < steps / 2 ? 0.8 : 0.5;
    }
    Eigen::Matrix<double, 5, 1> result;
    result << motion.x, motion.y, motion.heading, motion.velocity.linear, motion.velocity.angular;
    sum += result;
    squares += result * result.transpose();
  }
  const Eigen::Matrix<double, 5, 1> mean = sum / runs;
  const Eigen::Matrix<double, 5, 5> covariance = squares / runs - mean * mean.transpose();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(motion.covariance(i, j), covariance(i, j), 0.15 * std::sqrt(covariance(i, i) * covariance(j, j)))
          << i << " " << j;
  EXPECT_NEAR(motion.variance.linear, covariance(3, 3), 0.1 * covariance(3, 3));
  EXPECT_NEAR(motion.variance.angular, covariance(4, 4), 0.1 * covariance(4, 4));
}

TEST(Ros2Drive, FourWheelsAreMeasuredByTheirMean) {
  TwoWheels robot;
  add_wheel(robot.model, "left_rear", 0.2, 0.05);
  add_wheel(robot.model, "right_rear", -0.2, 0.05);
  for (const auto& [name, offset] : {std::pair("left_rear", 2U), std::pair("right_rear", 3U)}) {
    robot.robot.command_channels.push_back(channel(std::string(name) + "/0/velocity", offset));
    robot.robot.observation_channels.push_back(channel(std::string(name) + "/0/position", offset));
  }
  Drive drive = robot.drive();
  expect_near(commanded(drive, {0.1, 0.5}, 4), {0.0, 4.0, 0.0, 4.0});
  drive.measure(std::vector<double>(4, 0.0), 0.0);
  const PlanarMotion motion = drive.measure(std::vector<double>{1.0, 3.0, 3.0, 5.0}, 1.0);
  EXPECT_NEAR(motion.velocity.linear, 0.05 * 3.0, 1e-12);
  EXPECT_NEAR(motion.velocity.angular, 0.05 * 2.0 / 0.4, 1e-12);
}

TEST(Ros2Drive, WheelsOnOneSideOrAcrossDriveNothing) {
  TwoWheels robot;
  robot.model.links[2].X_ML.position.y() = 0.3;  // both are left
  EXPECT_FALSE(Drive::of(robot.model, robot.robot, {}));
  TwoWheels across;
  across.model.joints[1].axis.direction = {1.0, 0.0, 0.0};
  EXPECT_FALSE(Drive::of(across.model, across.robot, {}));
}

TEST(Ros2Drive, ADriveOfTheBodyUsesTheVelocityDirectlyAndIsMeasuredByItsWheels) {
  const auto expect_drive = [](description::Device device) {
    TwoWheels robot;
    std::erase_if(robot.model.devices,
                  [](const auto& each) { return std::holds_alternative<description::VelocityMotor>(each); });
    robot.model.devices.push_back(std::move(device));
    robot.robot.command_channels = {channel("drive/0/linear", 1, -0.5, 0.5), channel("drive/0/angular", 0, -2.0, 2.0)};
    Drive drive = Drive::of(robot.model, robot.robot, {}).value();
    expect_near(commanded(drive, {0.2, -0.5}), {-0.5, 0.2});
    expect_near(commanded(drive, {1.0, 1.0}), {0.5, 0.5});
    ASSERT_TRUE(drive.measures());
    drive.measure(std::vector<double>{0.0, 0.0}, 0.0);
    const PlanarMotion motion = drive.measure(std::vector<double>{1.0, 3.0}, 1.0);
    EXPECT_NEAR(motion.velocity.linear, 0.2 * 2.0 / 2.0, 1e-12);
    EXPECT_NEAR(motion.velocity.angular, 0.1 * 2.0 / 0.5, 1e-12);
  };
  description::DifferentialDrive differential;
  differential.name = "drive";
  differential.left_joints = {0};
  differential.right_joints = {1};
  differential.wheel_radius = 0.1;
  differential.wheel_separation = 0.5;
  expect_drive(differential);
  description::AckermannDrive ackermann;
  ackermann.name = "drive";
  ackermann.left_joints = {0};
  ackermann.right_joints = {1};
  ackermann.wheel_radius = 0.1;
  ackermann.wheel_separation = 0.5;
  expect_drive(ackermann);
}

TEST(Ros2Drive, TreelsHaveTheVelocityOfTheBodyAtTheirPosition) {
  description::Model model;
  description::TreelDrive treels;
  treels.name = "treels";
  treels.half_gauge = 0.05;
  description::TreelEncoder encoder;
  encoder.name = "way";
  model.devices = {treels, encoder};
  Start robot;
  robot.command_channels = {channel("treels/left/velocity", 0), channel("treels/right/velocity", 1)};
  robot.observation_channels = {channel("way/left/position", 0), channel("way/right/position", 1)};
  Drive drive = Drive::of(model, robot, {}).value();
  expect_near(commanded(drive, {0.1, 1.0}), {0.05, 0.15});
  drive.measure(std::vector<double>{0.0, 0.0}, 0.0);
  const PlanarMotion motion = drive.measure(std::vector<double>{0.05, 0.15}, 1.0);
  EXPECT_NEAR(motion.velocity.linear, 0.1, 1e-12);
  EXPECT_NEAR(motion.velocity.angular, 1.0, 1e-12);
}

TEST(Ros2Drive, NamedChannelsReplaceTheModelsWheels) {
  TwoWheels robot;
  description::Ros2Drive wheels;
  wheels.left = {"left/0/velocity"};
  wheels.right = {"right/0/velocity"};
  wheels.wheel_radius = 0.1;
  wheels.wheel_separation = 0.2;
  Drive drive = Drive::of(robot.model, robot.robot, wheels).value();
  expect_near(commanded(drive, {0.1, 0.5}), {0.5, 1.5});
  EXPECT_TRUE(drive.measures());
  wheels.right = {"middle/0/velocity"};
  try {
    static_cast<void>(Drive::of(robot.model, robot.robot, wheels));
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(
        error.what(),
        "'ros2: drive' names the channel 'middle/0/velocity', which robots of the model 'two_wheels' do not have");
  }
}

TEST(Ros2Drive, WithoutEncodersOnBothSidesNothingIsMeasured) {
  TwoWheels robot;
  robot.robot.observation_channels.pop_back();
  EXPECT_FALSE(robot.drive().measures());
  robot.robot.observation_channels.clear();
  EXPECT_FALSE(robot.drive().measures());
}

}  // namespace
}  // namespace cohort::ros2
