// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/worlds/sensing_world.hpp"

/// Images of cameras, compared with closed forms.
namespace cohort {
namespace {

using namespace test;
using description::Marker;
using std::numbers::pi;
constexpr double eye = 0.075;  // height of the camera and of the LEDs: the middle of the turret
constexpr double turret_radius = 0.058;

description::Model seeing_robot(std::size_t capacity = 8) {
  description::Model model = tracked_robot();
  model.devices.push_back(
      description::OmnidirectionalCamera{"camera", 1, {{0, 0, 0.02}}, 2.0, -1.0, 1.0, capacity, {}});
  model.devices.push_back(description::LedRing{"leds", 1, {{0, 0, 0.02}}, 8, 0.0, pi / 4.0, turret_radius, 0.0});
  return model;
}

std::string spot(std::size_t index, const std::string& quantity) {
  return "camera/" + std::to_string(index) + "/" + quantity;
}

TEST(OmnidirectionalCamera, ReportsBearingElevationDistanceAndColorNearestFirst) {
  SensingWorld world;
  world.add(seeing_robot(), "robot", at(0.3, -0.2, 0, 0.5));
  world.add_emitter("far", Marker{{0.25, 0.5, 1.0}}, at(0.3 - 0.8, -0.2 + 0.6, eye + 0.75));
  world.add_emitter("near", Marker{{1.0, 0.0, 0.0}}, at(0.3, -0.2 + 0.5, eye));
  world.add_emitter("black", Marker{{0.0, 0.0, 0.0}}, at(0.6, -0.2, eye));
  EXPECT_EQ(world.read(0, "camera/0/count"), 2.0);
  EXPECT_NEAR(world.read(0, spot(0, "bearing")), pi / 2.0 - 0.5, 1e-12);
  EXPECT_NEAR(world.read(0, spot(0, "elevation")), 0.0, 1e-12);
  EXPECT_NEAR(world.read(0, spot(0, "distance")), 0.5, 1e-12);
  EXPECT_EQ(world.read(0, spot(0, "color"), 0), 1.0);
  EXPECT_EQ(world.read(0, spot(0, "color"), 1), 0.0);
  EXPECT_NEAR(world.read(0, spot(1, "bearing")), std::atan2(0.6, -0.8) - 0.5, 1e-12);
  EXPECT_NEAR(world.read(0, spot(1, "elevation")), std::atan2(0.75, 1.0), 1e-12);
  EXPECT_NEAR(world.read(0, spot(1, "distance")), 1.25, 1e-12);
  const double color[] = {0.25, 0.5, 1.0};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(world.read(0, spot(1, "color"), i), color[i]);
  EXPECT_EQ(world.read(0, spot(2, "distance")), 0.0) << "nothing more";
}

TEST(OmnidirectionalCamera, SeesNothingOccludedOrOutOfRangeOrOutsideItsElevations) {
  SensingWorld world;
  world.add(seeing_robot(), "robot", at(0, 0, 0));
  world.add(seeing_robot(), "in the way", at(0, 0.5, 0));
  world.add(static_shape("wall", description::Box{{0.1, 1.0, 0.4}}), "wall", at(0.5, 0, 0.2));
  world.add_emitter("behind a wall", Marker{}, at(1.0, 0.0, eye));
  world.add_emitter("behind a robot", Marker{}, at(0.0, 1.0, eye));
  world.add_emitter("too far", Marker{}, at(-2.01, 0.0, eye));
  world.add_emitter("too high", Marker{}, at(-0.1, 0.0, eye + 0.1 * std::tan(1.01)));
  world.add_emitter("too low", Marker{}, at(0.0, -0.06, eye - 0.06 * std::tan(1.01) + 0.03));
  world.add_emitter("over the wall", Marker{}, at(0.5, 0.0, eye + 0.5 * std::tan(0.99)));
  EXPECT_EQ(world.read(0, "camera/0/count"), 2.0);
  EXPECT_NEAR(world.read(0, spot(0, "bearing")), -pi / 2.0, 1e-12);
  EXPECT_NEAR(world.read(0, spot(1, "elevation")), 0.99, 1e-12);
}

// In a ring of LEDs on a cylinder, those are visible whose side faces the camera: within acos(radius / distance).
TEST(OmnidirectionalCamera, SeesLedsOnTheNearSideOfAnotherRobotButNotItsOwn) {
  SensingWorld world;
  world.add(seeing_robot(), "robot", at(0, 0, 0));
  world.add(seeing_robot(), "shining", at(0.5, 0, 0));
  for (const std::uint32_t robot : {0U, 1U})
    for (int led = 0; led < 8; ++led)
      world.command(robot, "leds/" + std::to_string(led) + "/color", {0.1 * led, 1.0, 0.0});
  world.step();
  EXPECT_EQ(world.read(0, "camera/0/count"), 3.0);
  EXPECT_NEAR(world.read(0, spot(0, "color"), 0), 0.4, 1e-12) << "LED 4 faces the camera";
  EXPECT_NEAR(world.read(0, spot(0, "distance")), 0.5 - turret_radius, 1e-3);
  const double aside = turret_radius * std::sqrt(0.5);
  for (const std::size_t i : {1, 2}) {
    const double bearing = std::atan2(aside, 0.5 - aside);
    const bool is_left = world.read(0, spot(i, "color"), 0) < 0.4;  // LED 3 is at 135 degrees
    EXPECT_NEAR(world.read(0, spot(i, "bearing")), is_left ? bearing : -bearing, 1e-3);
  }
}

TEST(OmnidirectionalCamera, ReportsTheNearestIfMoreAreVisibleThanFit) {
  SensingWorld world;
  world.add(seeing_robot(3), "robot", at(0, 0, 0));
  for (int i = 0; i < 6; ++i) {
    const double distance = 1.2 - 0.1 * i;
    world.add_emitter("spot" + std::to_string(i), Marker{},
                      at(distance * std::cos(1.0 * i), distance * std::sin(1.0 * i), eye));
  }
  EXPECT_EQ(world.read(0, "camera/0/count"), 3.0);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(world.read(0, spot(i, "distance")), 0.7 + 0.1 * static_cast<double>(i), 1e-12);
}

TEST(OmnidirectionalCamera, HasNoiseOnPositionsButNotOnCountsAndColors) {
  SensingWorld world;
  description::Model robot = seeing_robot();
  description::Readout& readout = *description::readout_of(robot.devices[5]);
  readout.noises.resize(2);
  readout.noises[0].quantity = "distance";
  readout.noises[0].deviation = 0.05;
  readout.noises[1].quantity = "bearing";
  readout.noises[1].deviation = 0.02;
  world.add(robot, "robot", at(0, 0, 0));
  world.add_emitter("spot", Marker{{1.0, 0.5, 0.0}}, at(1.0, 0.0, eye));
  double sum = 0.0, squares = 0.0, bearing_squares = 0.0;
  constexpr int ticks = 400;
  for (int tick = 0; tick < ticks; ++tick) {
    world.step();
    const double error = world.read(0, spot(0, "distance")) - 1.0;
    sum += error;
    squares += error * error;
    bearing_squares += world.read(0, spot(0, "bearing")) * world.read(0, spot(0, "bearing"));
    EXPECT_EQ(world.read(0, "camera/0/count"), 1.0);
    EXPECT_EQ(world.read(0, spot(0, "color"), 1), 0.5);
  }
  // Within four standard deviations of each estimator.
  EXPECT_NEAR(sum / ticks, 0.0, 4.0 * 0.05 / std::sqrt(ticks));
  EXPECT_NEAR(squares / ticks, 0.0025, 4.0 * 0.0025 * std::sqrt(2.0 / ticks));
  EXPECT_NEAR(bearing_squares / ticks, 0.0004, 4.0 * 0.0004 * std::sqrt(2.0 / ticks));
}

description::Model filming_robot(std::size_t width, std::size_t height) {
  description::Model model = tracked_robot();
  description::PanoramicCamera camera;
  camera.name = "film";
  camera.link = 1;
  camera.X_LS = {{0, 0, 0.02}};
  camera.width = width;
  camera.height = height;
  camera.min_elevation = -0.5;
  camera.max_elevation = 0.5;
  camera.sky = {0.25, 0.5, 0.75};
  model.devices.push_back(camera);
  return model;
}

TEST(Panorama, ShowsSkyGroundAndObjects) {
  constexpr std::size_t width = 72, height = 20;
  SensingWorld world;
  world.add(filming_robot(width, height), "robot", at(0, 0, 0));
  description::Model box = static_shape("box", description::Box{{0.2, 0.4, 0.4}});
  box.links[0].color = {1.0, 0.0, 0.5};
  world.add(box, "box", at(1.1, 0, eye));
  // l = (2, 1, 3) / sqrt(14): the ground looks up, the face of the box along -x, away from the light.
  const double ground = 0.4 + 0.6 * 3.0 / std::sqrt(14.0);
  int faces = 0;
  for (std::size_t row = 0; row < height; ++row)
    for (std::size_t column = 0; column < width; ++column) {
      const double bearing = 2.0 * pi * static_cast<double>(column) / width;
      const double elevation = 0.5 - (static_cast<double>(row) + 0.5) / height;
      const double across = std::tan(bearing), up = std::tan(elevation) / std::cos(bearing);
      const bool is_face = std::cos(bearing) > 0.0 && std::abs(across) < 0.2 && std::abs(up) < 0.2 && up > -eye;
      const Eigen::Vector3d expected = is_face           ? Eigen::Vector3d(0.4, 0.0, 0.2)
                                       : elevation < 0.0 ? Eigen::Vector3d(ground * 0.5 * Eigen::Vector3d::Ones())
                                                         : Eigen::Vector3d(0.25, 0.5, 0.75);
      for (std::size_t part = 0; part < 3; ++part)
        EXPECT_NEAR(world.read(0, "film/0/image", 3 * (row * width + column) + part), expected[static_cast<int>(part)],
                    1e-12)
            << row << " " << column;
      faces += is_face ? 1 : 0;
    }
  EXPECT_GT(faces, 20);
}

TEST(Panorama, DrawsMarkersAsSpotsOfFiveMillimetres) {
  constexpr std::size_t width = 720, height = 120;
  SensingWorld world;
  world.add(filming_robot(width, height), "robot", at(0, 0, 0));
  const Eigen::Vector3d red(1.0, 0.0, 0.0), blue(0.0, 0.0, 1.0);
  world.add_emitter("near", Marker{red}, at(0.0, 0.2, eye + 0.02));
  world.add_emitter("far away", Marker{blue}, at(-5.0, 0.0, eye + 0.5));
  int reds = 0, blues = 0;
  for (std::size_t row = 0; row < height; ++row)
    for (std::size_t column = 0; column < width; ++column) {
      Eigen::Vector3d seen;
      for (std::size_t part = 0; part < 3; ++part)
        seen[static_cast<int>(part)] = world.read(0, "film/0/image", 3 * (row * width + column) + part);
      const double bearing = 2.0 * pi * static_cast<double>(column) / width;
      const double elevation = 0.5 - (static_cast<double>(row) + 0.5) / height;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(bearing), std::cos(elevation) * std::sin(bearing),
                                      std::sin(elevation));
      const double angle = std::acos(direction.dot(Eigen::Vector3d(0.0, 0.2, 0.02).normalized()));
      EXPECT_EQ(seen == red, angle < std::asin(0.005 / std::hypot(0.2, 0.02))) << row << " " << column;
      reds += seen == red ? 1 : 0;
      blues += seen == blue ? 1 : 0;
    }
  EXPECT_GT(reds, 20);
  EXPECT_EQ(blues, 1) << "smaller than a pixel";
}

}  // namespace
}  // namespace cohort
