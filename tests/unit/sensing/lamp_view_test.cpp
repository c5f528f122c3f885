// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/exteroceptive/lamp_view.hpp"

#include <gtest/gtest.h>

#include "server/core/random.hpp"
#include "tests/support/worlds/sensing_world.hpp"

namespace cohort::sensing {
namespace {

using namespace test;

description::Model robot_with_light_sensors(double led_intensity = 0.0) {
  description::Model model = tracked_robot();
  model.devices.push_back(description::LightSensors{"light", 1, {{0.01, 0, 0.045}}, 8, 0.0, 0.785, 0.5, {}});
  model.devices.push_back(description::LedRing{"leds", 1, {{0, 0, 0.045}}, 8, 0.0, 0.785, 0.05, led_intensity});
  return model;
}

TEST(LampView, GivesTheSameResultsForManyRingsAndForFew) {
  const RandomStream random(5, "lamp_view_test", "places");
  SensingWorld world;
  const auto place = [&](std::uint64_t n, double z) {
    return at(3.0 * random.uniform(n, 0), 3.0 * random.uniform(n, 1), z);
  };
  constexpr std::uint32_t robots = 60;
  for (std::uint32_t n = 0; n < robots; ++n)
    world.add(robot_with_light_sensors(1.0), "robot" + std::to_string(n), place(n, 0.0));
  world.add(static_shape("wall", description::Box{{0.1, 1.5, 0.4}}), "wall", at(1.5, 1.5, 0.2, 0.3));
  for (std::uint32_t n = 0; n < 10; ++n)
    world.add_emitter("lamp" + std::to_string(n), description::Light{}, place(1000 + n, 0.05 + 0.05 * n));
  for (std::uint32_t robot = 0; robot < robots; robot += 7)
    world.command(robot, "leds/" + std::to_string(robot % 8) + "/color", {1.0, 0.5, 0.0});
  world.step();

  const emission::Emitters& emitters = world.simulation().emitters();
  ASSERT_EQ(emitters.lit_lamps().size(), 10 + 9);
  LampView by_lamp(world.simulation().world(), emitters);
  LampView by_rays(world.simulation().world(), emitters);
  for (std::uint32_t robot = 0; robot < robots; ++robot) {
    const BodyId body{world.world().robots[robot]};
    EXPECT_EQ(by_lamp.add_ring(body, LinkId{1}, {0.01, 0, 0.045}), robot);
    by_rays.add_ring(body, LinkId{1}, {0.01, 0, 0.045});
    by_lamp.ask(robot);
  }
  WorkerPool workers(3);
  by_lamp.update(workers);
  by_rays.update(workers);
  int seen = 0, hidden = 0;
  for (std::uint32_t lamp = 0; lamp < emitters.lit_lamps().size(); ++lamp)
    for (std::uint32_t ring = 0; ring < robots; ++ring) {
      if (emitters.lamp(emitters.lit_lamps()[lamp]).mount.body == BodyId{world.world().robots[ring]}) continue;
      const bool sees = by_rays.is_in_sight(lamp, ring);
      EXPECT_EQ(by_lamp.is_in_sight(lamp, ring), sees) << lamp << " " << ring;
      ++(sees ? seen : hidden);
    }
  EXPECT_GT(seen, 200);
  EXPECT_GT(hidden, 200);
}

// The sensors of few robots are served by rays and those of many lamp by lamp: in one world, by the rate that they ask
// at.
TEST(LampView, GivesARobotTheSameReadingsIndependentlyOfOthers) {
  const auto reading = [](std::chrono::nanoseconds period_of_others) {
    SensingWorld world;
    description::Model others = robot_with_light_sensors();
    description::readout_of(others.devices[5])->period = period_of_others;
    world.add(robot_with_light_sensors(), "robot", at(0, 0, 0));
    for (int n = 0; n < 40; ++n)
      world.add(others, "other" + std::to_string(n), at(0.4 + 0.2 * (n % 8), 0.2 * static_cast<double>(n / 8), 0.0));
    for (int n = 0; n < 6; ++n)
      world.add_emitter("lamp" + std::to_string(n), description::Light{}, at(3.0 - 0.3 * n, 0.4 * n, 0.08 + 0.2 * n));
    world.step(3);
    std::vector<double> readings;
    for (int i = 0; i < 8; ++i) readings.push_back(world.read(0, "light/" + std::to_string(i) + "/reading"));
    return readings;
  };
  const std::vector<double> alone = reading(std::chrono::seconds(1));
  EXPECT_GT(alone[0], 0.0);
  EXPECT_EQ(alone, reading({}));
}

}  // namespace
}  // namespace cohort::sensing
