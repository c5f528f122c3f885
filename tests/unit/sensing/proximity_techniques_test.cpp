// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "server/core/random.hpp"
#include "server/sensing/readings/take_samples.hpp"
#include "tests/support/worlds/sensing_world.hpp"

/// The ways to measure proximity, against closed forms and each other.
namespace cohort {
namespace {

using namespace test;
using description::ProximityTechnique;
using std::numbers::pi;
constexpr double ring_radius = 0.058;
constexpr double range = 0.2;
constexpr double cone = 40.0 * pi / 180.0;
constexpr double ring_height = 0.075;

description::Model robot_with(ProximityTechnique technique, const description::Samples& samples = {}) {
  description::Model model = tracked_robot();
  auto& ring = std::get<description::ProximityRing>(model.devices[4]);
  ring.first_bearing = 0.0;
  ring.technique = technique;
  ring.cone = cone;
  if (technique == ProximityTechnique::samples) ring.samples = std::make_shared<const description::Samples>(samples);
  return model;
}

double reading(SensingWorld& world, std::size_t sensor) {
  return world.read(0, "proximity/" + std::to_string(sensor) + "/reading");
}

// Before a wall at distance d a ray that leaves the axis by an angle t is 1 / cos t as long.
double before_wall(double distance, double angle) { return std::max(0.0, 1.0 - distance / std::cos(angle) / range); }

double reading_before_wall(ProximityTechnique technique, double distance) {
  SensingWorld world;
  world.add(robot_with(technique), "robot", at(0, 0, 0));
  world.add(static_shape("wall", description::Box{{0.1, 2.0, 2.0}}), "wall", at(ring_radius + distance + 0.05, 0, 0));
  return reading(world, 0);
}

TEST(FiveRays, ReadTheMeanOfFive) {
  const double angle = std::sqrt(5.0 / 8.0) * cone / 2.0;
  for (const double distance : {0.02, 0.1, 0.15})
    EXPECT_NEAR(reading_before_wall(ProximityTechnique::five_rays, distance),
                (before_wall(distance, 0.0) + 4.0 * before_wall(distance, angle)) / 5.0, 1e-12);
}

TEST(FiveRays, ReadTheMeanOverTheConeForSmoothFunctions) {
  // Over solid angle, by a fine sum.
  const double distance = 0.1;
  double sum = 0.0;
  constexpr int parts = 10'000;
  for (int i = 0; i < parts; ++i) {
    const double cosine = 1.0 - (i + 0.5) / parts * (1.0 - std::cos(cone / 2.0));
    sum += before_wall(distance, std::acos(cosine));
  }
  EXPECT_NEAR(reading_before_wall(ProximityTechnique::five_rays, distance), sum / parts, 1e-4);
}

TEST(FiveRays, DetectObjectsThatOneRayMisses) {
  const auto reads = [](ProximityTechnique technique) {
    SensingWorld world;
    world.add(robot_with(technique), "robot", at(0, 0, 0));
    world.add(static_shape("stick", description::Cylinder{0.01, 1.0}), "stick", at(ring_radius + 0.1, 0.028, 0));
    return reading(world, 0);
  };
  EXPECT_EQ(reads(ProximityTechnique::ray), 0.0);
  EXPECT_GT(reads(ProximityTechnique::five_rays), 0.05);
  EXPECT_GT(reads(ProximityTechnique::shadow), 0.05);
}

TEST(RandomRay, FillsTheConeEvenly) {
  SensingWorld world;
  world.add(robot_with(ProximityTechnique::random_ray), "robot", at(0, 0, 0));
  world.add(static_shape("wall", description::Box{{0.1, 2.0, 2.0}}), "wall", at(ring_radius + 0.15, 0, 0));
  const double distance = 0.1, least = before_wall(distance, cone / 2.0), most = before_wall(distance, 0.0);
  // cos t is uniform: so is 1 / (1 - reading), which is proportional to it.
  const double from = distance / range / (1.0 - least), to = distance / range / (1.0 - most);
  double sum = 0.0;
  constexpr int ticks = 500;
  for (int tick = 0; tick < ticks; ++tick) {
    world.step();
    EXPECT_GE(reading(world, 0), least - 2e-3);
    EXPECT_LE(reading(world, 0), most + 2e-3);
    sum += distance / range / (1.0 - reading(world, 0));
  }
  EXPECT_NEAR(sum / ticks, (from + to) / 2.0, 4.0 * (to - from) / std::sqrt(12.0 * ticks) + 1e-3);
}

TEST(RandomRay, DependsOnSensorTickSeedAndName) {
  const auto run = [](std::uint64_t seed, unsigned threads) {
    SensingWorld world(threads);
    world.experiment.seed = seed;
    world.add(robot_with(ProximityTechnique::random_ray), "robot", at(0, 0, 0));
    world.add(static_shape("post", description::Cylinder{0.03, 1.0}), "post", at(0.15, 0.02, 0));
    std::vector<double> readings;
    for (int tick = 0; tick < 5; ++tick) {
      world.step();
      for (std::size_t i = 0; i < 15; ++i) readings.push_back(reading(world, i));
    }
    return readings;
  };
  EXPECT_EQ(run(1, 1), run(1, 3));
  EXPECT_NE(run(1, 1), run(2, 1));
}

TEST(Shadow, ReadsTheMeanOverTheDirectionsIntoTheMouthOfTheCone) {
  // Degrees of the ring within atan2(range sin 20, radius + range cos 20), before a wall.
  const double distance = 0.1;
  const double width = std::atan2(range * std::sin(cone / 2.0), ring_radius + range * std::cos(cone / 2.0));
  double sum = 0.0;
  int count = 0;
  for (int degree = -180; degree < 180; ++degree) {
    const double bearing = degree * pi / 180.0;
    if (std::abs(bearing) > width) continue;
    ++count;
    sum += std::max(0.0, 1.0 - ((ring_radius + distance) / std::cos(bearing) - ring_radius) / range);
  }
  EXPECT_NEAR(reading_before_wall(ProximityTechnique::shadow, distance), sum / count, 1e-12);
}

// Upright things in the plane of the ring: there the techniques measure the same, as well as they can.
TEST(Techniques, AgreeOnCylindersAndWallsThatFillTheCone) {
  const RandomStream random(3, "proximity_techniques_test", "places");
  double worst_shadow = 0.0, worst_random = 0.0;
  for (std::uint64_t n = 0; n < 40; ++n) {
    const double radius = 0.05 + 0.1 * random.uniform(n, 0), gap = 0.02 + 0.1 * random.uniform(n, 1);
    const double bearing = 2.0 * pi * random.uniform(n, 2), centre = ring_radius + gap + radius;
    const auto readings = [&](ProximityTechnique technique, int ticks) {
      SensingWorld world;
      world.add(robot_with(technique), "robot", at(0, 0, 0));
      const description::Shape shape = n % 2 == 0 ? description::Shape(description::Cylinder{radius, 1.0})
                                                  : description::Box{{2.0 * radius, 1.0, 1.0}};
      world.add(static_shape("thing", shape), "thing",
                at(centre * std::cos(bearing), centre * std::sin(bearing), 0.5, bearing));
      std::vector<double> means(15);
      for (int tick = 0; tick < ticks; ++tick) {
        if (tick > 0) world.step();
        for (std::size_t i = 0; i < 15; ++i) means[i] += reading(world, i) / ticks;
      }
      return means;
    };
    const std::vector<double> five = readings(ProximityTechnique::five_rays, 1);
    const std::vector<double> shadow = readings(ProximityTechnique::shadow, 1);
    const std::vector<double> drawn = readings(ProximityTechnique::random_ray, 200);
    const auto sensor = static_cast<std::size_t>(std::lround(bearing / (2.0 * pi / 15.0))) % 15;
    EXPECT_GT(five[sensor], 0.1) << n;
    worst_shadow = std::max(worst_shadow, std::abs(shadow[sensor] - five[sensor]));
    worst_random = std::max(worst_random, std::abs(drawn[sensor] - five[sensor]));
  }
  EXPECT_LT(worst_shadow, 0.1);
  EXPECT_LT(worst_random, 0.1);
}

// 15 readings; that of sensor i is 10 d + (its bearing is that of the object).
description::Samples simple_samples() {
  description::Samples samples;
  samples.distances = {0.0, 0.3};
  for (int i = 0; i < 15; ++i) {
    samples.angles.push_back(2.0 * pi * i / 15.0);
    samples.units.emplace_back("mV");
  }
  for (const double distance : samples.distances)
    for (int angle = 0; angle < 15; ++angle)
      for (int i = 0; i < 15; ++i) samples.readings.push_back(10.0 * distance + (angle == i ? 1.0 : 0.0));
  return samples;
}

TEST(Samples, AreLookedUpByDistanceAndBearingAndTheGreatestIsUsed) {
  SensingWorld world;
  world.add(robot_with(ProximityTechnique::samples, simple_samples()), "robot", at(0, 0, 0, 0.3));
  world.add(static_shape("post", description::Cylinder{0.05, 1.0}), "post",
            at(0.2 * std::cos(0.3), 0.2 * std::sin(0.3), 0));  // straight ahead, its rim 0.15 m away
  EXPECT_NEAR(reading(world, 0), 1.5 + 1.0, 1e-9);
  EXPECT_NEAR(reading(world, 5), 1.5, 1e-9);
  bool found = false;
  for (const Channel& channel : world.simulation().kinds()[0].observation)
    if (channel.name == "proximity/3/reading") {
      found = true;
      EXPECT_EQ(channel.unit, "mV");
      EXPECT_EQ(channel.upper, 4.0);
    }
  EXPECT_TRUE(found);
}

TEST(Samples, UseTheNearestPointOfAWallAndTheGreatestOfSeveralObjects) {
  SensingWorld world;
  world.add(robot_with(ProximityTechnique::samples, simple_samples()), "robot", at(0, 0, 0));
  world.add(static_shape("wall", description::Box{{4.0, 0.1, 1.0}}), "wall", at(1.5, 0.3, 0));   // 0.25 m to the left
  world.add(static_shape("post", description::Cylinder{0.05, 1.0}), "post", at(0.15, 0, 0));     // 0.1 m ahead
  world.add(static_shape("low", description::Box{{0.4, 0.4, 0.04}}), "low", at(-0.3, 0, 0.02));  // below the ring
  EXPECT_NEAR(reading(world, 0), std::max(1.0 + 1.0, 2.5), 1e-9);
  // The bearing of 90 degrees is 3.75 sensors round: a quarter of sensor 3 and three of sensor 4.
  EXPECT_NEAR(reading(world, 3), 2.5 + 0.25, 1e-9);
  EXPECT_NEAR(reading(world, 4), 2.5 + 0.75, 1e-9);
  EXPECT_NEAR(reading(world, 9), 2.5, 1e-9);
}

TEST(Samples, TakenInTheSimulatorReproduceTheRing) {
  const description::Model real = robot_with(ProximityTechnique::five_rays);
  sensing::SampleGrid grid;
  grid.radius = 0.05;
  grid.distances = 41;
  grid.angles = 360;
  const description::Samples samples = sensing::take_samples(real, 4, grid);
  EXPECT_EQ(samples.count(), 15u);
  EXPECT_EQ(samples.readings.size(), 41u * 360u * 15u);
  for (const double angle : {0.0, 0.3, 2.0, 5.5})
    for (const double gap : {0.005, 0.0523, 0.17}) {
      const auto readings = [&](const description::Model& model) {
        SensingWorld world;
        world.add(model, "robot", at(0, 0, 0));
        const double away = ring_radius + gap + 0.05;
        world.add(static_shape("post", description::Cylinder{0.05, 0.5}), "post",
                  at(away * std::cos(angle), away * std::sin(angle), ring_height));
        std::vector<double> values;
        for (std::size_t i = 0; i < 15; ++i) values.push_back(reading(world, i));
        return values;
      };
      const std::vector<double> rays = readings(real);
      const std::vector<double> table = readings(robot_with(ProximityTechnique::samples, samples));
      // Where a ray begins to meet the post within a cell of the table, a fifth of a reading is smeared over it.
      for (std::size_t i = 0; i < 15; ++i) EXPECT_NEAR(table[i], rays[i], 0.2) << angle << " " << gap << " " << i;
    }
}

TEST(Samples, ReplaceSquareAndCosineOfLightAndSound) {
  description::Samples samples;  // two readings that fall linearly from 1 and 2 at 0 m to 0 at 2 m, all round
  samples.distances = {0.0, 2.0};
  samples.angles = {0.0};
  samples.units = {"1", "1"};
  samples.readings = {1.0, 2.0, 0.0, 0.0};
  const auto shared = std::make_shared<const description::Samples>(samples);
  SensingWorld world;
  description::Model robot = tracked_robot();
  description::LightSensors light{"light", 1, {{0, 0, 0.045}}, 2, 0.0, pi, 0.5, {}};
  light.samples = shared;
  description::Microphones ears{"ears", 1, {{0, 0, 0.045}, {0, 0, 0.045}}, {{0, 500}}, 2.0, {}};
  ears.samples = shared;
  robot.devices.push_back(light);
  robot.devices.push_back(ears);
  world.add(robot, "robot", at(0, 0, 0));
  description::Light lamp;
  lamp.intensity = 3.0;
  lamp.color = {1.0, 0.5, 0.0};
  world.add_emitter("lamp", lamp, at(0.5, 0.0, 0.1));
  world.add_emitter("other", description::Light{}, at(0.0, 1.5, 0.1));
  world.add_emitter("whistle", description::Sound{400.0, 0.5}, at(0.0, -1.0, 0.055));
  world.add_emitter("bat", description::Sound{40'000.0, 0.5}, at(0.0, -0.5, 0.055));
  EXPECT_NEAR(world.read(0, "light/0/reading"), sigmoid(0.5 * (1.5 * 0.75 + 0.25)), 1e-12);
  EXPECT_NEAR(world.read(0, "light/1/reading"), sigmoid(0.5 * 2.0 * (1.5 * 0.75 + 0.25)), 1e-12);
  EXPECT_NEAR(world.read(0, "ears/0/intensity"), sigmoid(2.0 * 0.5 * 0.5), 1e-12);
  EXPECT_NEAR(world.read(0, "ears/1/intensity"), sigmoid(2.0 * 0.5 * 1.0), 1e-12);
}

}  // namespace
}  // namespace cohort
