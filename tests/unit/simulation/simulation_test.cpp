// SPDX-License-Identifier: Apache-2.0
#include "server/simulation/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/robots.hpp"

namespace cohort {
namespace {

using namespace test;

description::Experiment experiment_of(description::World world, description::Policy policy = {}) {
  description::Experiment experiment;
  experiment.world = std::move(world);
  experiment.duration = std::chrono::seconds(1);
  description::Team team{"team", {}, "none", policy};
  for (std::uint32_t robot = 0; robot < experiment.world.robots.size(); ++robot) team.robots.push_back(robot);
  experiment.teams.push_back(team);
  return experiment;
}

// In the order of the model's devices: turret, treel encoder, ring; and treel drive, turret motor.
constexpr std::size_t turret_position = 0, left_position = 2, left_velocity = 3;
constexpr std::size_t command_left = 0;

TEST(Simulation, DescribesItsRobotsByChannel) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "robot", at(0, 0, 0));
  const description::Experiment experiment = experiment_of(world);
  const Simulation simulation(experiment, 1);
  ASSERT_EQ(simulation.kinds().size(), 1u);
  const RobotKind& kind = simulation.kinds()[0];
  EXPECT_EQ(kind.observation[turret_position].name, "turret/0/position");
  EXPECT_EQ(kind.observation[left_position].name, "treel/left/position");
  EXPECT_EQ(kind.observation[first_reading + 14].name, "proximity/14/reading");
  EXPECT_EQ(kind.observation_size, 21u);
  EXPECT_EQ(kind.command[command_left].name, "treel/left/velocity");
  EXPECT_EQ(kind.command[command_left].unit, "m/s");
  EXPECT_EQ(kind.command[command_left].upper, 0.2);
  EXPECT_EQ(kind.command_size, 3u);
}

TEST(Simulation, SensesTickZeroBeforeAnythingMoves) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "robot", at(0, 0, 0));
  // A wall across sensor 0, which looks 12 degrees to the left from the turret's rim.
  place(world, static_shape("wall", description::Box{{0.1, 2.0, 0.3}}), "wall", at(0.2, 0, 0.15));
  const description::Experiment experiment = experiment_of(world);
  const Simulation simulation(experiment, 1);
  EXPECT_EQ(simulation.tick(), 0u);
  const double bearing = 12.0 * M_PI / 180.0;
  const double distance = 0.15 / std::cos(bearing) - 0.058;
  EXPECT_NEAR(simulation.observation(0)[first_reading], 1.0 - distance / 0.2, 1e-9);
  EXPECT_NEAR(simulation.observation(0)[first_reading + 14], 1.0 - distance / 0.2, 1e-9) << "its mirror image";
  EXPECT_EQ(simulation.observation(0)[first_reading + 7], 0.0) << "nothing behind";
}

TEST(Simulation, NumbersProximitySensorsCounterClockwiseFromTheGripper) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "robot", at(0, 0, 0));
  place(world, static_shape("post", description::Cylinder{0.02, 0.3}), "post", at(0.02, 0.15, 0.15));  // to the left
  const description::Experiment experiment = experiment_of(world);
  const Simulation simulation(experiment, 1);
  for (std::size_t sensor = 0; sensor < 15; ++sensor)
    EXPECT_EQ(simulation.observation(0)[first_reading + sensor] > 0.0, sensor == 3) << sensor;  // 84 degrees
}

TEST(Simulation, CountsTicksAndTimeInWholeNanoseconds) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "robot", at(0, 0, 0));
  const description::Experiment experiment = experiment_of(world);
  Simulation simulation(experiment, 1);
  for (int i = 0; i < 3; ++i) simulation.step();
  EXPECT_EQ(simulation.tick(), 3u);
  EXPECT_EQ(simulation.time(), std::chrono::milliseconds(30));
}

TEST(Simulation, HoldsACommandUntilTheNextOne) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "robot", at(0, 0, 0));
  const description::Experiment experiment = experiment_of(world);
  Simulation simulation(experiment, 1);
  simulation.set_command(0, std::vector<double>{0.1, 0.1, 0.0});
  for (int i = 0; i < 100; ++i) simulation.step();
  EXPECT_NEAR(simulation.observation(0)[left_velocity], 0.1, 0.001);
  simulation.set_neutral_command(0);
  for (int i = 0; i < 50; ++i) simulation.step();
  EXPECT_NEAR(simulation.observation(0)[left_velocity], 0.0, 0.001);
  EXPECT_NEAR(simulation.observation(0)[left_position], simulation.robot_pose(0).position.x(), 0.002);
}

TEST(Simulation, NamesTheChannelOfAnInvalidCommand) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "robot", at(0, 0, 0));
  const description::Experiment experiment = experiment_of(world);
  const Simulation simulation(experiment, 1);
  using Reason = CommandFault::Reason;
  EXPECT_FALSE(simulation.check_command(0, std::vector<double>{0.2, -0.2, 1.5}));
  EXPECT_EQ(simulation.check_command(0, std::vector<double>{0.0, 0.0})->reason, Reason::wrong_size);
  const auto nan = simulation.check_command(0, std::vector<double>{0.0, std::nan(""), 0.0});
  EXPECT_EQ(nan->reason, Reason::not_finite);
  EXPECT_EQ(nan->channel, "treel/right/velocity");
  const auto fast = simulation.check_command(0, std::vector<double>{0.3, 0.0, 0.0});
  EXPECT_EQ(fast->reason, Reason::out_of_range);
  EXPECT_EQ(fast->channel, "treel/left/velocity");
  EXPECT_NE(fast->text.find("robot"), std::string::npos);
  EXPECT_NE(fast->text.find("0.3 m/s, expected -0.2 to 0.2"), std::string::npos) << fast->text;
}

TEST(Simulation, RefreshesAnObservationOnlyWhenItsRobotIsDue) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "robot", at(0, 0, 0));
  const description::Experiment experiment = experiment_of(world, {4, 1, 0, description::OnLate::wait, {}});
  Simulation simulation(experiment, 1);
  simulation.set_command(0, std::vector<double>{0.2, 0.2, 0.0});
  std::vector<double> positions;
  for (int i = 0; i < 9; ++i) {
    simulation.step();
    positions.push_back(simulation.observation(0)[left_position]);
  }
  EXPECT_GT(positions[4], positions[3]) << "tick 5 is due";
  EXPECT_EQ(positions[5], positions[4]);
  EXPECT_EQ(positions[7], positions[4]);
  EXPECT_GT(positions[8], positions[7]) << "tick 9 is due";
}

TEST(Simulation, NoiseOfOneRobotDoesNotDependOnTheOthers) {
  const auto readings_of_last = [](int others) {
    description::World world = world_with_floor();
    for (int i = 0; i < others; ++i)
      place(world, tracked_robot(0.01), "other_" + std::to_string(i), at(2.0 + 0.5 * i, 0, 0));
    place(world, tracked_robot(0.01), "robot", at(0, 0, 0));
    place(world, static_shape("wall", description::Box{{0.1, 2.0, 0.3}}), "wall", at(0.2, 0, 0.15));
    const description::Experiment experiment = experiment_of(world);
    Simulation simulation(experiment, 1);
    const auto values = simulation.observation(static_cast<std::uint32_t>(others));
    return std::vector<double>(values.begin(), values.end());
  };
  EXPECT_EQ(readings_of_last(0), readings_of_last(3));
}

TEST(Simulation, HashCoversStateCommandsAndObservations) {
  description::World world = world_with_floor();
  place(world, tracked_robot(0.01), "robot", at(0, 0, 0));
  const description::Experiment experiment = experiment_of(world);
  Simulation first(experiment, 1), second(experiment, 1);
  EXPECT_EQ(first.state_hash(), second.state_hash());
  first.set_command(0, std::vector<double>{0.1, 0.1, 0.0});
  EXPECT_NE(first.state_hash(), second.state_hash());
  second.set_command(0, std::vector<double>{0.1, 0.1, 0.0});
  for (int i = 0; i < 20; ++i) {
    first.step();
    second.step();
    ASSERT_EQ(first.state_hash(), second.state_hash());
  }
  description::Experiment other_seed = experiment;
  other_seed.seed = 2;
  EXPECT_NE(Simulation(other_seed, 1).state_hash(), Simulation(experiment, 1).state_hash()) << "the noise differs";
}

TEST(Simulation, CountsContactsWithObstaclesAndRobotsSeparately) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "pusher", at(0, 0, 0));
  place(world, tracked_robot(), "free", at(0, 1, 0));
  place(world, static_shape("wall", description::Box{{0.1, 0.5, 0.3}}), "wall", at(0.12, 0, 0.15));
  const description::Experiment experiment = experiment_of(world);
  Simulation simulation(experiment, 1);
  simulation.set_command(0, std::vector<double>{0.2, 0.2, 0.0});
  for (int i = 0; i < 100; ++i) simulation.step();
  EXPECT_EQ(simulation.touches().robot_ticks, 200u);
  EXPECT_GT(simulation.touches().obstacles, 80u);
  EXPECT_LE(simulation.touches().obstacles, 100u);
  EXPECT_EQ(simulation.touches().robots, 0u);
}

TEST(Simulation, NamesTheRobotThatLeftTheWorldAndContinues) {
  description::World world;
  world.physics.lowest = -1.0;
  place(world, static_shape("table", description::Box{{1.0, 1.0, 0.1}}), "table", at(0, 0, -0.05));
  place(world, tracked_robot(), "falls", at(2, 0, 0));
  place(world, tracked_robot(), "stays", at(0, 0, 0));
  description::Experiment experiment = experiment_of(world);
  {
    Simulation simulation(experiment, 1);
    std::vector<std::string> quarantined;
    while (simulation.tick() < 100) {
      simulation.step();
      quarantined.insert(quarantined.end(), simulation.quarantined().begin(), simulation.quarantined().end());
    }
    EXPECT_EQ(quarantined, std::vector<std::string>{"'falls' has left the world"});
    EXPECT_NEAR(simulation.robot_pose(1).position.z(), 0.0, 1e-3);
  }
  experiment.world.physics.strict = true;
  Simulation strict(experiment, 1);
  EXPECT_THROW(while (strict.tick() < 100) strict.step(), std::runtime_error);
}

TEST(Simulation, EndsItsTicksForAnyPoseThatTheDescriptionHas) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const double number : {1e30, -1e142, 1e300, infinite, -infinite, nan})
    for (int coordinate = 0; coordinate < 7; ++coordinate)
      for (const std::size_t instance : {1U, 2U}) {
        SCOPED_TRACE(std::to_string(number) + " in " + std::to_string(coordinate));
        description::World world = world_with_floor();
        place(world, static_shape("wall", description::Box{{0.1, 0.5, 0.3}}), "wall", at(0.5, 0, 0.15));
        place(world, tracked_robot(), "odd", at(0, 0, 0));
        place(world, tracked_robot(), "usual", at(0, 1, 0));
        Pose& X_WM = world.instances[instance].X_WM;
        (coordinate < 3 ? X_WM.position[coordinate] : X_WM.orientation.coeffs()[coordinate - 3]) = number;
        Simulation simulation(experiment_of(world), 1);
        for (int i = 0; i < 3; ++i) simulation.step();
        EXPECT_TRUE(simulation.robot_pose(1).position.allFinite());
      }
}

TEST(Simulation, GivesTheSameBitsWhenRebuilt) {
  description::World world = world_with_floor();
  for (int i = 0; i < 5; ++i) place(world, tracked_robot(0.01), "robot_" + std::to_string(i), at(0.13 * i, 0, 0, i));
  const description::Experiment experiment = experiment_of(world);
  const auto hash = [&] {
    Simulation simulation(experiment, 1);
    const std::vector<double> command{0.1, 0.12, 0.3};
    for (std::uint32_t robot = 0; robot < 5; ++robot) simulation.set_command(robot, command);
    for (int i = 0; i < 100; ++i) simulation.step();
    return simulation.state_hash();
  };
  EXPECT_EQ(hash(), hash());
}

}  // namespace
}  // namespace cohort
