// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/worlds/sensing_world.hpp"

/// Lights, sounds and what hears and sees them, against closed forms.
namespace cohort {
namespace {

using namespace std::chrono_literals;
using namespace test;
using description::Light;
using description::Sound;
using std::numbers::pi;

// A robot with tracks that also has 8 light sensors 10 cm high, microphones, LEDs and a loudspeaker.
description::Model beacon_robot(double led_intensity = 0.0) {
  description::Model model = tracked_robot();
  model.devices.push_back(description::LightSensors{"light", 1, {{0, 0, 0.045}}, 8, 0.0, pi / 4.0, 0.5, {}});
  model.devices.push_back(description::Microphones{
      "microphones", 1, {{0.03, 0, 0.045}, {-0.03, 0, 0.045}}, {{200, 400}, {400, 800}}, 2.0, {}});
  model.devices.push_back(description::LedRing{"leds", 1, {{0, 0, 0.045}}, 8, 0.0, pi / 4.0, 0.05, led_intensity});
  model.devices.push_back(description::Loudspeaker{"speaker", 1, {{0, 0, 0.045}}, 5000.0, 4.0});
  return model;
}
constexpr double sensor_height = 0.1;

TEST(LightSensors, ReadTheInverseSquareTheCosineAndTheSigmoid) {
  SensingWorld world;
  world.add(beacon_robot(), "robot", at(0, 0, 0));
  Light light;
  light.intensity = 3.0;
  light.color = {1.0, 0.5, 0.0};
  world.add_emitter("lamp", light, at(2.0, 1.0, sensor_height + 0.5));
  const double square = 4.0 + 1.0 + 0.25;
  const double arriving = 3.0 * 0.5 / square;
  for (std::size_t i = 0; i < 8; ++i) {
    const double bearing = static_cast<double>(i) * pi / 4.0;
    const double cosine = (2.0 * std::cos(bearing) + std::sin(bearing)) / std::sqrt(square);
    EXPECT_NEAR(world.read(0, "light/" + std::to_string(i) + "/reading"),
                sigmoid(0.5 * arriving * std::max(0.0, cosine)), 1e-12)
        << i;
  }
}

TEST(LightSensors, SumOverLampsBeforeTheySaturate) {
  SensingWorld world;
  world.add(beacon_robot(), "robot", at(0, 0, 0));
  world.add_emitter("near", Light{}, at(1.0, 0.0, sensor_height));
  world.add_emitter("far", Light{}, at(2.0, 0.0, sensor_height));
  EXPECT_NEAR(world.read(0, "light/0/reading"), sigmoid(0.5 * (1.0 + 0.25)), 1e-12);
  EXPECT_EQ(world.read(0, "light/4/reading"), 0.0) << "looks away";
}

TEST(LightSensors, SeeNoLampBehindAWall) {
  SensingWorld world;
  world.add(beacon_robot(), "robot", at(0, 0, 0));
  world.add_emitter("lamp", Light{}, at(1.0, 0.0, sensor_height));
  world.add(static_shape("wall", description::Box{{0.1, 1.0, 0.4}}), "wall", at(0.5, 0, 0.2));
  EXPECT_EQ(world.read(0, "light/0/reading"), 0.0);
  world.simulation().act(RemoveObject{"wall"});
  world.step();
  EXPECT_GT(world.read(0, "light/0/reading"), 0.1);
}

TEST(LightSensors, KeepToTheAttenuationOfALampAndItsRange) {
  SensingWorld world;
  world.add(beacon_robot(), "robot", at(0, 0, 0));
  Light light;
  light.constant = 0.5;
  light.linear = 1.0;
  light.quadratic = 2.0;
  light.range = 3.0;
  world.add_emitter("lamp", light, at(2.0, 0.0, sensor_height));
  world.add_emitter("too far", light, at(3.1, 0.0, sensor_height));
  EXPECT_NEAR(world.read(0, "light/0/reading"), sigmoid(0.5 / (0.5 + 2.0 + 8.0)), 1e-12);
}

TEST(LightSensors, ASpotShinesWithinItsConeAndADirectionalLightEverywhere) {
  Light spot;
  spot.kind = Light::Kind::spot;
  spot.direction_E = {-1, 0, 0};
  spot.inner_angle = 0.2;
  spot.outer_angle = 0.6;
  spot.falloff = 2.0;
  const auto reading = [&](const Light& light, double y) {
    SensingWorld world;
    world.add(beacon_robot(), "robot", at(0, 0, 0));
    world.add_emitter("lamp", light, at(1.0, y, sensor_height));
    return world.read(0, "light/0/reading");
  };
  const auto expected = [](double y, double share) {
    return sigmoid(0.5 * share / (1.0 + y * y) / std::sqrt(1.0 + y * y));
  };
  EXPECT_NEAR(reading(spot, 0.1), expected(0.1, 1.0), 1e-12);
  EXPECT_EQ(reading(spot, 1.0), 0.0);
  const double y = std::tan(0.4);
  const double share = (std::cos(0.4) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
  EXPECT_NEAR(reading(spot, y), expected(y, share * share), 1e-12);

  Light sun;
  sun.kind = Light::Kind::directional;
  sun.direction_E = {-1, 0, 0};
  sun.intensity = 0.7;
  EXPECT_NEAR(reading(sun, 5.0), sigmoid(0.5 * 0.7), 1e-12);
}

TEST(Lights, GoOffAndOnAgainByEventsAndMoveWithTheirObject) {
  SensingWorld world;
  world.add(beacon_robot(), "robot", at(0, 0, 0));
  const std::uint32_t lamp = world.add_emitter("lamp", Light{}, at(1.0, 0.0, sensor_height));
  world.experiment.events.push_back({20ms, lamp, description::SetPresence{false}, "disable"});
  world.experiment.events.push_back({40ms, lamp, description::SetPresence{true}, "enable"});
  world.experiment.events.push_back({60ms, lamp, description::PlaceAt{at(-1, 0, sensor_height)}, "move"});
  const auto front = [&] { return world.read(0, "light/0/reading"); };
  EXPECT_GT(front(), 0.2);
  world.step();
  EXPECT_GT(front(), 0.2);
  world.step();
  EXPECT_EQ(front(), 0.0) << "off at 20 ms";
  world.step(2);
  EXPECT_GT(front(), 0.2) << "on at 40 ms";
  world.step(2);
  EXPECT_EQ(front(), 0.0) << "behind it at 60 ms";
  EXPECT_GT(world.read(0, "light/4/reading"), 0.2);
}

TEST(Leds, AreLampsToOthersAtTheTickAfterTheCommand) {
  SensingWorld world;
  world.add(beacon_robot(4.0), "shining", at(1.0, 0, 0));
  world.add(beacon_robot(4.0), "looking", at(0, 0, 0));
  world.simulation();
  EXPECT_EQ(world.read(1, "light/0/reading"), 0.0);
  world.command(0, "leds/4/color", {1.0, 1.0, 1.0});  // faces the other one
  world.step();
  const double distance = 1.0 - 0.05;
  EXPECT_NEAR(world.read(1, "light/0/reading"), sigmoid(0.5 * 4.0 / (distance * distance)), 1e-3);
  EXPECT_EQ(world.read(0, "light/4/reading"), 0.0) << "a robot does not dazzle itself";
}

TEST(Microphones, ReadTheInverseSquareInTheirBand) {
  SensingWorld world;
  world.add(beacon_robot(), "robot", at(0, 0, 0));
  world.add_emitter("siren", Sound{300.0, 0.5}, at(2.0, 0.0, sensor_height));
  world.add_emitter("whistle", Sound{600.0, 0.25}, at(0.0, 1.0, sensor_height));
  world.add_emitter("bat", Sound{40'000.0, 10.0}, at(0.0, 0.5, sensor_height));
  world.add(static_shape("wall", description::Box{{0.1, 4.0, 0.4}}), "wall", at(1.0, 0, 0.2));  // hides no sound
  EXPECT_NEAR(world.read(0, "microphones/0/intensity", 0), sigmoid(2.0 * 0.5 / (1.97 * 1.97)), 1e-12);
  EXPECT_NEAR(world.read(0, "microphones/1/intensity", 0), sigmoid(2.0 * 0.5 / (2.03 * 2.03)), 1e-12);
  EXPECT_NEAR(world.read(0, "microphones/0/intensity", 1), sigmoid(2.0 * 0.25 / (1.0 + 0.03 * 0.03)), 1e-12);
}

TEST(Loudspeaker, IsHeardByOthersAndNotByItself) {
  SensingWorld world;
  world.add(beacon_robot(), "calling", at(0.5, 0, 0));
  world.add(beacon_robot(), "hearing", at(0, 0, 0));
  world.command(0, "speaker/0/frequency", {500.0, 4.0});
  world.step();
  EXPECT_EQ(world.read(1, "microphones/0/intensity", 0), 0.0) << "another band";
  EXPECT_NEAR(world.read(1, "microphones/0/intensity", 1), sigmoid(2.0 * 4.0 / (0.47 * 0.47)), 1e-3);
  EXPECT_EQ(world.read(0, "microphones/0/intensity", 1), 0.0);
}

TEST(GroundSensors, SeeTheGroundAndTheEdgeOfATable) {
  SensingWorld world;
  world.world().instances.clear();
  world.world().models.clear();
  world.add(static_shape("table", description::Box{{1.0, 1.0, 0.5}}), "table", at(0, 0, -0.25));
  description::Model robot = tracked_robot();
  robot.devices.push_back(description::GroundSensors{"ground", 0, {{0.05, 0, 0.01}, {-0.05, 0, 0.01}}, 0.04, {}});
  world.add(robot, "robot", at(0.47, 0, 0));
  EXPECT_EQ(world.read(0, "ground/0/reading"), 0.0) << "beyond the edge";
  EXPECT_NEAR(world.read(0, "ground/1/reading"), 1.0 - 0.01 / 0.04, 1e-9);
}

// Everything that has a memory, on any number of threads, and from a snapshot.
TEST(Emitters, AndDelayedSensorsAreTheSameOnAnyThreadsAndAfterRestore) {
  SensingWorld world;
  description::Model robot = beacon_robot(2.0);
  description::Readout& readout = *description::readout_of(robot.devices[5]);
  readout.noises.emplace_back();
  readout.noises[0].deviation = 0.01;
  readout.period = 30ms;
  readout.latency = 50ms;
  readout.drop_out = 0.1;
  for (int i = 0; i < 40; ++i)
    world.add(robot, "robot" + std::to_string(i), at(0.3 * (i % 8), 0.3 * static_cast<double>(i / 8), 0));
  world.add_emitter("lamp", Light{}, at(1.0, 3.0, 0.3));
  const auto drive = [&](int from, int to) {
    std::uint64_t hash = 0;
    for (int tick = from; tick < to; ++tick) {
      for (std::uint32_t id = 0; id < 40; ++id) {
        const double phase = 0.1 * tick + id;
        world.command(id, "leds/" + std::to_string(id % 8) + "/color", {0.5 + 0.5 * std::sin(phase), 0.0, 1.0});
        world.command(id, "treel/left/velocity", {0.1 * std::sin(phase)});
        world.command(id, "speaker/0/frequency", {500.0, 1.0});
      }
      world.step();
      hash = world.simulation().state_hash();
    }
    return hash;
  };
  const std::uint64_t whole = drive(0, 60);
  world.begin_again(4);
  drive(0, 33);
  const std::vector<std::byte> snapshot = world.simulation().save();
  EXPECT_EQ(drive(33, 60), whole);
  world.begin_again(2);
  world.simulation().restore(snapshot);
  EXPECT_EQ(drive(33, 60), whole);
}

}  // namespace
}  // namespace cohort
