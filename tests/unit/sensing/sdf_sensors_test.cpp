// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/sensed.hpp"

/// SDF's own sensors, and the cohort: ones that are like them, against closed forms.
namespace cohort {
namespace {

using namespace test;
using description::Box;
using description::Device;
using description::Model;
using std::numbers::pi;

description::Lidar lidar(std::size_t columns, double bearing, std::size_t rows = 1, double elevation = 0.0) {
  description::Lidar result;
  result.name = "lidar";
  result.columns = columns;
  result.rows = rows;
  result.min_bearing = -bearing;
  result.max_bearing = bearing;
  result.min_elevation = -elevation;
  result.max_elevation = elevation;
  result.min_range = 0.15;
  result.max_range = 8.0;
  return result;
}

TEST(LidarSensor, MeasuresAWallInRowsFromTheLowestAndTheRight) {
  description::Lidar sensor = lidar(5, 0.5, 3, 0.2);
  sensor.X_LS.position.x() = 0.05;
  Sensed sensed(sensor);
  sensed.add_wall({0.2, 20, 20}, at(2.1, 0, 5));  // its face is at x = 2, 1.95 m ahead, and above the floor
  const std::vector<double> ranges = sensed.read();
  ASSERT_EQ(ranges.size(), 15u);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 5; ++column) {
      const double elevation = -0.2 + 0.2 * row;
      const double bearing = -0.5 + 0.25 * column;
      EXPECT_NEAR(ranges[static_cast<std::size_t>(5 * row + column)], 1.95 / (std::cos(elevation) * std::cos(bearing)),
                  1e-9)
          << row << " " << column;
    }
  EXPECT_EQ(sensed.channels()[0].name, "lidar/0/ranges");
  EXPECT_EQ(sensed.channels()[0].size, 15u);
}

TEST(LidarSensor, TurnsPositiveBearingsToTheLeftAndPositiveElevationsUp) {
  Sensed sensed(lidar(3, 0.5 * pi, 3, 0.4), at(0, 0, 1));
  sensed.add_wall({1, 1, 10}, at(0, 1.5, 0));  // on the left, 1 m away
  const std::vector<double> ranges = sensed.read();
  EXPECT_NEAR(ranges[3 + 2], 1.0, 1e-9) << "the middle row, the last column";
  EXPECT_EQ(ranges[3 + 0], 8.0) << "nothing on the right";
  EXPECT_NEAR(ranges[0 + 1], 1.0 / std::sin(0.4), 1e-9) << "the lowest row meets the floor";
  EXPECT_EQ(ranges[6 + 1], 8.0) << "the highest row meets nothing";
}

TEST(LidarSensor, WithOneRayPointsToTheMiddleOfItsAngles) {
  description::Lidar sensor = lidar(1, 0.0);
  sensor.min_bearing = 0.2;
  sensor.max_bearing = 0.6;
  Sensed sensed(sensor);
  sensed.add_wall({0.2, 20, 20}, at(2.1, 0, 5));
  EXPECT_NEAR(sensed.read()[0], 2.0 / std::cos(0.4), 1e-9);
}

TEST(LidarSensor, ReadsTheMaximumRangeWithoutAHitAndTheMinimumIfTooNear) {
  description::Lidar sensor = lidar(3, pi / 2);
  sensor.X_LS.position.x() = 0.2;
  Sensed sensed(sensor);
  sensed.add_wall({0.2, 0.1, 1}, at(0.4, 0, 1));  // its face is 0.1 m ahead, less than the least range
  const std::vector<double> ranges = sensed.read();
  EXPECT_EQ(ranges[0], 8.0);
  EXPECT_EQ(ranges[1], 0.15);
}

TEST(LidarSensor, IgnoresItsOwnBody) { EXPECT_EQ(Sensed(lidar(1, 0.0)).read()[0], 8.0); }

TEST(LidarSensor, HasTheGivenNoiseOnEveryRayExceptOutOfRange) {
  constexpr std::size_t count = 20'000;
  description::Lidar sensor = lidar(count, 0.0);
  sensor.readout.noises.push_back(noise_on("ranges", 0.05));
  sensor.readout.noises[0].mean = 0.3;
  const std::vector<double> nothing = Sensed(sensor).report(7);
  for (const double range : nothing) ASSERT_EQ(range, 8.0);
  Sensed before_a_wall(sensor);
  before_a_wall.add_wall({0.2, 20, 20}, at(0.2, 0, 5));  // its face is 0.1 m ahead, less than the least range
  for (const double range : before_a_wall.report(7)) ASSERT_EQ(range, 0.15);

  Sensed sensed(sensor);
  sensed.add_wall({0.2, 20, 20}, at(2.1, 0, 5));
  const std::vector<double> ranges = sensed.report(7);
  double mean = 0.0;
  for (const double range : ranges) mean += range / count;
  double variance = 0.0;
  for (const double range : ranges) variance += (range - mean) * (range - mean) / (count - 1);
  EXPECT_NEAR(mean, 2.3, 4.0 * 0.05 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(variance), 0.05, 4.0 * 0.05 / std::sqrt(2.0 * count));
}

TEST(LidarSensor, ReadsWholeMultiplesOfItsResolution) {
  description::Lidar sensor = lidar(3, 0.5);
  sensor.readout.noises.push_back(noise_on("ranges", 0.0));
  sensor.readout.noises[0].precision = 0.25;
  Sensed sensed(sensor);
  sensed.add_wall({0.2, 0.2, 20}, at(2.3, 0, 5));
  const std::vector<double> ranges = sensed.report(0);
  EXPECT_EQ(ranges[0], 8.0);
  EXPECT_EQ(ranges[1], 2.25) << "2.2 m";
}

TEST(NoiseOfAnElement, AppliesToThatValueOfEachChannelOnly) {
  description::Magnetometer sensor{"m", 0, {}};
  sensor.readout.noises.push_back(noise_on("magnetic_field", 1.0, 1));
  Sensed sensed(sensor);
  const std::vector<double> exact = sensed.read();
  const std::vector<double> noisy = sensed.report(3);
  EXPECT_EQ(noisy[0], exact[0]);
  EXPECT_NE(noisy[1], exact[1]);
  EXPECT_EQ(noisy[2], exact[2]);
}

// Two collisions: a foot that stands on the floor, and a hat that touches nothing.
Model standing(std::size_t collision) {
  Model model = loose("standing", Box{{0.2, 0.2, 0.2}}, solid_box(2.0, {0.2, 0.2, 0.2}));
  model.links[0].collisions.push_back({"hat", {{0, 0, 0.2}}, Box{{0.1, 0.1, 0.1}}, {}});
  model.devices.push_back(description::ContactSensor{"touch", 0, collision});
  return model;
}

TEST(ContactSensor, MeasuresTheWeightOnItsCollision) {
  Sensed sensed(standing(0), at(0, 0, 0.1));
  EXPECT_EQ(sensed.value("touching"), 0.0) << "before the first step";
  sensed.small.run(1.0);
  EXPECT_EQ(sensed.value("touching"), 1.0);
  EXPECT_NEAR(sensed.value("force"), 2.0 * 9.81, 0.01);
}

TEST(ContactSensor, IgnoresOtherCollisionsOfItsLink) {
  Sensed sensed(standing(1), at(0, 0, 0.1));
  sensed.small.run(1.0);
  EXPECT_EQ(sensed.value("touching"), 0.0);
  EXPECT_EQ(sensed.value("force"), 0.0);
}

TEST(ContactSensor, MeasuresAnObjectOnTopOfIt) {
  Sensed sensed(standing(1), at(0, 0, 0.1));
  sensed.small.add(loose("load", Box{{0.1, 0.1, 0.1}}, solid_box(0.5, {0.1, 0.1, 0.1})), at(0, 0, 0.4));
  sensed.small.run(1.0);
  EXPECT_EQ(sensed.value("touching"), 1.0);
  EXPECT_NEAR(sensed.value("force"), 0.5 * 9.81, 0.01);
}

TEST(ContactSensor, OfAPlanarBodyMeasuresAWallThatItHits) {
  Model robot = tracked_robot();
  robot.devices.insert(robot.devices.begin(), description::ContactSensor{"touch", 1, 0});
  for (Device& device : robot.devices)
    if (auto* const encoder = std::get_if<description::TreelEncoder>(&device)) encoder->drive = 1;
  Sensed sensed(robot, at(0, 0, 0));
  sensed.small.description.physics.fidelity = description::Fidelity::planar;
  sensed.add_wall({0.1, 2.0, 0.3}, at(0.058 + 0.05 + 0.02, 0, 0.15));
  EXPECT_EQ(sensed.value("touching"), 0.0);
  sensed.small.world().set_device_target(sensed.body, DeviceId{1}, 0, 0.1);
  sensed.small.world().set_device_target(sensed.body, DeviceId{1}, 1, 0.1);
  sensed.small.run(1.0);
  EXPECT_EQ(sensed.value("touching"), 1.0);
  EXPECT_GT(sensed.value("force"), 0.1);
}

TEST(AltimeterSensor, MeasuresAFallFromItsInitialHeight) {
  Sensed sensed(description::Altimeter{"a", 0, {}}, at(0, 0, 50));
  EXPECT_EQ(sensed.value("vertical_position"), 0.0);
  sensed.small.run(1.0);
  // Semi-implicit Euler: v_k = -g k h, z_k = -g h^2 k (k + 1) / 2.
  EXPECT_NEAR(sensed.value("vertical_velocity"), -9.81, 1e-9);
  EXPECT_NEAR(sensed.value("vertical_position"), -9.81 * 1e-4 * 100 * 101 / 2, 1e-9);
}

TEST(AltimeterSensor, HasTheVelocityOfItsOwnPositionOnARotatingBody) {
  Sensed sensed(description::Altimeter{"a", 0, {{0.3, 0, 0}}}, at(0, 0, 50));
  sensed.small.world().set_root_twist(sensed.body, {{0, -2.0, 0}, {0, 0, 0.5}});
  EXPECT_NEAR(sensed.value("vertical_velocity"), 0.5 + 2.0 * 0.3, 1e-12);
}

TEST(NavSatSensor, MeasuresItsOwnPositionAndVelocityInWorldAxes) {
  Sensed sensed(description::NavSat{"n", 0, {{0.3, 0, 0}}}, at(1, 2, 50, 0.5 * pi));
  sensed.small.world().set_root_twist(sensed.body, {{0, 0, 2.0}, {0.25, 0, 0.5}});
  EXPECT_TRUE(sensed.vector("position").isApprox(Eigen::Vector3d(1, 2.3, 50), 1e-12));
  EXPECT_TRUE(sensed.vector("velocity").isApprox(Eigen::Vector3d(0.25 - 2.0 * 0.3, 0, 0.5), 1e-12));
}

TEST(MagnetometerSensor, MeasuresTheFieldOfTheWorldAlongItsOwnAxes) {
  Pose X_LS;
  X_LS.orientation = Eigen::AngleAxisd(0.5 * pi, Eigen::Vector3d::UnitX());  // y up, z backwards to the right
  Sensed sensed(description::Magnetometer{"m", 0, X_LS}, at(0, 0, 1, 0.5 * pi));
  sensed.small.description.magnetic_field = {1e-6, 2e-6, 3e-6};
  // x of S is y of the world, y of S its z, z of S its x.
  EXPECT_TRUE(sensed.vector("magnetic_field").isApprox(Eigen::Vector3d(2e-6, 3e-6, 1e-6), 1e-12))
      << sensed.vector("magnetic_field").transpose();
}

TEST(InclinometerSensor, MeasuresRollAndPitchForAnyHeading) {
  for (const double yaw : {0.0, 1.0, -2.5})
    for (const double pitch : {0.0, 0.4, -1.2})
      for (const double roll : {0.0, -0.7, 2.8}) {
        Pose X_WL = at(0, 0, 1);
        X_WL.orientation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
        Sensed sensed(description::Inclinometer{"i", 0, {}}, X_WL);
        EXPECT_NEAR(sensed.value("roll"), roll, 1e-12);
        EXPECT_NEAR(sensed.value("pitch"), pitch, 1e-12);
      }
}

TEST(InclinometerSensor, ReadsZeroWithoutGravity) {
  Sensed sensed(description::Inclinometer{"i", 0, {}}, turned(0, 0, 1, {1, 2, 3}, 0.7));
  sensed.small.description.gravity.setZero();
  EXPECT_EQ(sensed.value("roll"), 0.0);
  EXPECT_EQ(sensed.value("pitch"), 0.0);
}

// Table I of ICAO Doc 7488 (geopotential altitude).
TEST(AirPressureSensor, FollowsTheStandardAtmosphere) {
  const auto standard_pressure = [](double height) {
    return Sensed(description::AirPressureSensor{"p", 0, {}, height}, at(0, 0, 0)).value("pressure");
  };
  EXPECT_EQ(standard_pressure(0.0), 101325.0);
  EXPECT_NEAR(standard_pressure(1000.0), 89874.6, 0.1);
  EXPECT_NEAR(standard_pressure(5000.0), 54019.9, 0.1);
  EXPECT_NEAR(standard_pressure(11000.0), 22632.0, 0.1);
  EXPECT_EQ(standard_pressure(50000.0), 0.0);
  Sensed sensed(description::AirPressureSensor{"p", 0, {{0, 0, 2}}, 996.0}, at(0, 0, 2));
  EXPECT_NEAR(sensed.value("pressure"), 89874.6, 0.1);
}

description::LogicalCamera camera() {
  description::LogicalCamera result;
  result.name = "camera";
  result.near = 0.5;
  result.far = 10.0;
  result.horizontal_fov = 0.5 * pi;  // as wide to a side as it is far
  result.aspect_ratio = 2.0;
  return result;
}

TEST(LogicalCameraSensor, SeesObjectsWithOriginInTheFrustumNearestFirst) {
  Sensed sensed(camera(), at(1, 1, 1, 0.5 * pi));  // looks along y
  const auto add = [&](double ahead, double left, double up) {
    const auto body = static_cast<std::uint32_t>(sensed.small.description.instances.size());
    sensed.add_wall({0.1, 0.1, 0.1}, at(1 - left, 1 + ahead, 1 + up, 0.7));
    return body;
  };
  const std::uint32_t far = add(9.9, 0, 0);
  const std::uint32_t on_the_left = add(4.0, 3.9, 1.9);
  const std::uint32_t near = add(0.6, 0, 0);
  add(0.4, 0, 0);
  add(10.1, 0, 0);
  add(4.0, 4.1, 0);
  add(4.0, 0, 2.1);
  add(-4.0, 0, 0);
  ASSERT_EQ(sensed.value("count"), 3.0);
  EXPECT_EQ(sensed.value("object", 0), near);
  EXPECT_EQ(sensed.value("object", 1), on_the_left);
  EXPECT_EQ(sensed.value("object", 2), far);
  EXPECT_EQ(sensed.value("object", 3), -1.0);
  EXPECT_TRUE(sensed.vector("position", 3).isApprox(Eigen::Vector3d(4.0, 3.9, 1.9), 1e-12));
  EXPECT_NEAR(sensed.value("orientation", 4 + 2), std::sin(0.5 * (0.7 - 0.5 * pi)), 1e-12);
  EXPECT_NEAR(sensed.value("orientation", 4 + 3), std::cos(0.5 * (0.7 - 0.5 * pi)), 1e-12);
}

TEST(LogicalCameraSensor, KeepsTheNearestIfMoreAreVisibleThanFit) {
  Sensed sensed(camera());
  for (int i = 0; i < 30; ++i) sensed.add_wall({0.05, 0.05, 0.05}, at(9.0 - 0.2 * i, 0, 1));
  EXPECT_EQ(sensed.value("count"), 16.0);
  EXPECT_NEAR(sensed.vector("position", 0).x(), 9.0 - 0.2 * 29, 1e-12);
  EXPECT_NEAR(sensed.vector("position", 3 * 15).x(), 9.0 - 0.2 * 14, 1e-12);
}

}  // namespace
}  // namespace cohort
