// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/simulation/simulation.hpp"
#include "tests/support/robots.hpp"

// A simulation with planar physics: controllers get the same sensors.
namespace cohort {
namespace {

using namespace test;

description::Experiment crowd(description::Fidelity fidelity) {
  description::Experiment experiment;
  experiment.world = world_with_floor();
  experiment.world.physics.fidelity = fidelity;
  experiment.duration = std::chrono::seconds(1);
  for (int i = 0; i < 9; ++i)
    place(experiment.world, tracked_robot(0.01), "robot_" + std::to_string(i), at(0.18 * (i % 3), 0.2 * (i / 3), 0, i));
  place(experiment.world, static_shape("wall", description::Box{{0.1, 2.0, 0.3}}), "wall", at(-0.2, 0, 0.15));
  place(experiment.world, static_shape("post", description::Cylinder{0.03, 0.3}), "post", at(0.3, 0.1, 0.15));
  description::Team team{"team", {}, "none", {}};
  for (std::uint32_t robot = 0; robot < experiment.world.robots.size(); ++robot) team.robots.push_back(robot);
  experiment.teams.push_back(team);
  return experiment;
}

constexpr std::size_t sensors = 15;

TEST(PlanarSimulation, SensesTheSameAsTheFullModelAtTheSamePoses) {
  const description::Experiment planar_experiment = crowd(description::Fidelity::planar);
  const description::Experiment full_experiment = crowd(description::Fidelity::treel);
  const Simulation planar(planar_experiment, 1);
  const Simulation full(full_experiment, 1);
  int seen = 0;
  for (std::uint32_t robot = 0; robot < 9; ++robot) {
    for (std::size_t i = first_reading; i < first_reading + sensors; ++i) {
      EXPECT_NEAR(planar.observation(robot)[i], full.observation(robot)[i], 1e-9) << robot << " " << i;
      seen += planar.observation(robot)[i] > 0.1 ? 1 : 0;
    }
  }
  EXPECT_GT(seen, 20);
}

TEST(PlanarSimulation, SensesTheSameAfterBothHaveDriven) {
  const description::Experiment planar_experiment = crowd(description::Fidelity::planar);
  const description::Experiment full_experiment = crowd(description::Fidelity::treel);
  Simulation planar(planar_experiment, 1);
  Simulation full(full_experiment, 1);
  for (Simulation* simulation : {&planar, &full}) {
    for (std::uint32_t robot = 0; robot < 9; ++robot)
      simulation->set_command(robot, std::vector<double>{0.02, -0.02, 0.5});
    for (int i = 0; i < 100; ++i) simulation->step();
  }
  for (std::uint32_t robot = 0; robot < 9; ++robot)
    for (std::size_t i = first_reading; i < first_reading + sensors; ++i)
      EXPECT_NEAR(planar.observation(robot)[i], full.observation(robot)[i], 0.02) << robot << " " << i;
}

TEST(PlanarSimulation, HasTheSameBitsForAnyNumberOfThreads) {
  const description::Experiment experiment = crowd(description::Fidelity::planar);
  const auto hash_with = [&](unsigned threads) {
    Simulation simulation(experiment, threads);
    for (std::uint32_t robot = 0; robot < 9; ++robot)
      simulation.set_command(robot, std::vector<double>{0.1, 0.05, 0.3});
    for (int i = 0; i < 100; ++i) simulation.step();
    return simulation.state_hash();
  };
  const std::uint64_t expected = hash_with(1);
  EXPECT_EQ(hash_with(2), expected);
  EXPECT_EQ(hash_with(4), expected);
}

}  // namespace
}  // namespace cohort
