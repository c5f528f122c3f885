// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/hosting/plugin_loader.hpp"
#include "tests/support/worlds/flat_arena.hpp"

namespace cohort {
namespace {

using namespace test;
using std::numbers::pi;

wire::RobotDescription sbot() {
  wire::RobotDescription description{.model = "sbot"};
  for (std::size_t i = 0; i < FlatArena::sensor_count; ++i) {
    description.observation.push_back({"proximity/" + std::to_string(i) + "/reading", "1", 1, 0.0, 1.0, 0.0});
  }
  description.observation.push_back({"turret/0/position", "rad", 1, -10.0, 10.0, 0.0});
  description.command = {{"treel/left/velocity", "m/s", 1, -0.2, 0.2, 0.0},
                         {"treel/right/velocity", "m/s", 1, -0.2, 0.2, 0.0},
                         {"turret/0/velocity", "rad/s", 1, -3.0, 3.0, 0.0}};
  return description;
}

// The shipped example, driving the robots of a flat arena.
class ObstacleAvoidanceTest : public testing::Test {
 protected:
  void place(double x, double y, double heading) { arena.robots.push_back({.x = x, .y = y, .heading = heading}); }

  void start() {
    wire::Admit admit;
    for (std::uint32_t id = 0; id < arena.robots.size(); ++id) {
      ids.push_back(id);
      admit.robots.push_back({.robot = id, .name = "sbot_" + std::to_string(id)});
    }
    host.start(admit, std::vector{sbot()});
  }

  std::vector<double> command(const std::vector<double>& observed) {
    const auto values = host.answer({.robots = std::span(ids).first(observed.size() / 16), .values = observed});
    return {values.begin(), values.end()};
  }

  void step() {
    std::vector<double> observed;
    for (std::size_t i = 0; i < arena.robots.size(); ++i) {
      const auto readings = arena.readings(i);
      observed.insert(observed.end(), readings.begin(), readings.end());
      observed.push_back(0.0);
    }
    const std::vector<double> commands = command(observed);
    for (std::size_t i = 0; i < arena.robots.size(); ++i) arena.drive(i, commands[3 * i], commands[3 * i + 1]);
    arena.separate();
  }

  LoadedPlugin plugin{"obstacle_avoidance", default_plugin_directories()};
  ControllerHost host{plugin.plugin()};
  FlatArena arena{2.0};
  std::vector<std::uint32_t> ids;
};

TEST_F(ObstacleAvoidanceTest, SixteenRobotsCoverAnArenaWithObstaclesAndHardlyTouchAnything) {
  std::mt19937 random(1);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  while (arena.obstacles.size() < 24) {
    const FlatArena::Disc disc{uniform(-2, 2), uniform(-2, 2), uniform(0.05, 0.15)};
    if (arena.is_free(disc.x, disc.y, disc.radius)) arena.obstacles.push_back(disc);
  }
  while (arena.robots.size() < 16) {
    const double x = uniform(-2, 2);
    const double y = uniform(-2, 2);
    if (arena.is_free(x, y, 0.1)) place(x, y, uniform(-pi, pi));
  }
  start();

  std::set<std::pair<int, int>> visited;  // squares of 20 cm
  int touching = 0;
  constexpr int steps = 6000;
  for (int i = 0; i < steps; ++i) {
    step();
    for (const auto& robot : arena.robots) {
      touching += robot.touches ? 1 : 0;
      visited.emplace(std::floor(robot.x / 0.2), std::floor(robot.y / 0.2));
    }
  }
  EXPECT_LT(touching, steps * 16 / 50) << "two in a hundred";
  EXPECT_GT(visited.size(), 280u) << "of 400, some of which are within obstacles";
}

TEST_F(ObstacleAvoidanceTest, ARobotThatDrivesIntoACornerGetsOutOfIt) {
  place(1.5, 1.5, pi / 4);
  start();
  bool was_in_it = false;
  bool left_it = false;
  for (int i = 0; i < 2000 && !left_it; ++i) {
    step();
    const double away = 2.0 - std::min(arena.robots[0].x, arena.robots[0].y);
    was_in_it = was_in_it || away < 0.25;
    left_it = was_in_it && away > 0.6;
  }
  EXPECT_TRUE(was_in_it);
  EXPECT_TRUE(left_it);
}

TEST_F(ObstacleAvoidanceTest, TwoRobotsThatMeetHeadOnPassEachOther) {
  place(-0.5, 0.0, 0.0);
  place(0.5, 0.0, pi);
  start();
  for (int i = 0; i < 1000; ++i) {
    step();
    EXPECT_FALSE(arena.robots[0].touches);
  }
  EXPECT_GT(std::hypot(arena.robots[0].x - arena.robots[1].x, arena.robots[0].y - arena.robots[1].y), 0.5);
}

TEST_F(ObstacleAvoidanceTest, AnObstacleOnTheLeftSlowsTheRightTrack) {
  place(0.0, 0.0, 0.0);
  start();
  std::vector<double> observed(16, 0.0);
  EXPECT_EQ(command(observed), (std::vector<double>{0.2, 0.2, 0.0}));
  observed[1] = 0.5;
  EXPECT_EQ(command(observed)[0], 0.2);
  EXPECT_LT(command(observed)[1], 0.2);
}

TEST_F(ObstacleAvoidanceTest, TheAnswerDependsOnlyOnTheObservation) {
  place(0.0, 0.0, 0.0);
  start();
  std::vector<double> near(16, 0.9);
  const std::vector<double> clear(16, 0.0);
  const std::vector<double> at_first = command(clear);
  command(near);
  EXPECT_EQ(command(clear), at_first);
}

TEST_F(ObstacleAvoidanceTest, TheTurretIsTurnedBackToTheFront) {
  place(0.0, 0.0, 0.0);
  start();
  std::vector<double> observed(16, 0.0);
  observed[15] = 0.2;
  EXPECT_LT(command(observed)[2], 0.0);
}

}  // namespace
}  // namespace cohort
