// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/simulation/simulation.hpp"
#include "tests/support/robots.hpp"

namespace cohort {
namespace {

using namespace std::chrono_literals;
using namespace test;

// A robot that can call, and events that bring more robots and boxes.
class Spawners : public ::testing::TestWithParam<description::Fidelity> {
 protected:
  Spawners() {
    description::World& world = experiment_.world;
    world = world_with_floor();
    world.physics.fidelity = GetParam();
    description::Model robot = tracked_robot();
    robot.devices.push_back(description::UserAction{"call"});
    place(world, robot, "team/a", at(0, 0, 0));
    place(world, static_shape("post", description::Box{{0.1, 0.1, 0.4}}), "team/late_2", at(3, 0, 0.2));
    experiment_.duration = 10s;
    experiment_.teams.push_back({"team", {0}, "none", {}});
    experiment_.teams.push_back({"other", {}, "none", {.period = 2}});
    world.models.push_back(newcomer());
    const std::size_t late = world.models.size() - 1;
    experiment_.spawners = {{"team/late", late, at(1, 1, 0), {0.4, 0.2}, "other", 3}};
  }
  static description::Model newcomer() {
    description::Model model = tracked_robot();
    model.name = "newcomer";
    return model;
  }
  void spawn_at(std::chrono::nanoseconds time) {
    experiment_.events.push_back({time, 0, description::SpawnNew{0}, "spawn"});
  }
  void spawn_on_call() {
    experiment_.reactions.push_back({"call", {0}, {{0ns, 0, description::SpawnNew{0}, "spawn"}}});
  }
  static void step(Simulation& simulation, double call = 0.0) {
    for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
      std::vector<double> command = {0.1, 0.1, 0.0};
      if (robot == 0) command.push_back(call);
      simulation.set_command(robot, command);
    }
    simulation.step();
  }
  // Boundaries at which the robot calls: every fourth.
  static void run(Simulation& simulation, int ticks) {
    for (; ticks > 0; --ticks) step(simulation, simulation.tick() % 4 == 1 ? 1.0 : 0.0);
  }

  description::Experiment experiment_;
};

INSTANTIATE_TEST_SUITE_P(Fidelities, Spawners,
                         ::testing::Values(description::Fidelity::treel, description::Fidelity::planar),
                         [](const auto& tested) {
                           return tested.param == description::Fidelity::planar ? "planar" : "treel";
                         });

TEST_P(Spawners, SpawnRobotsWithTheNextIdAndNumberAndTheirTeamsPolicy) {
  spawn_at(20ms);
  spawn_at(30ms);
  Simulation simulation(experiment_, 1);
  step(simulation);
  EXPECT_EQ(simulation.robot_count(), 1u);
  step(simulation);
  EXPECT_EQ(simulation.happened(), std::vector<std::string>{"spawn 'team/late_1' of model 'newcomer' in team 'other'"});
  step(simulation);
  ASSERT_EQ(simulation.robot_count(), 3u);
  EXPECT_EQ(simulation.robot_name(1), "team/late_1");
  EXPECT_EQ(simulation.robot_name(2), "team/late_3") << "something else is called late_2";
  EXPECT_EQ(simulation.policy(2).period, 2u);
  const Eigen::Vector3d first = simulation.robot_pose(1).position, second = simulation.robot_pose(2).position;
  EXPECT_NE(first.x(), second.x());
  EXPECT_NEAR(second.x(), 1.0, 0.21);
  EXPECT_NEAR(second.y(), 1.0, 0.11);
}

TEST_P(Spawners, SpawnOneForEachStartedActionUpToTheirLimit) {
  spawn_on_call();
  Simulation simulation(experiment_, 1);
  for (int i = 0; i < 3; ++i) {
    step(simulation, 1.0);
    step(simulation, 1.0);
    EXPECT_EQ(simulation.robot_count(), static_cast<std::uint32_t>(i + 2));
    step(simulation, 0.0);
  }
  step(simulation, 1.0);
  EXPECT_EQ(simulation.happened(),
            std::vector<std::string>{"call of 'team/a': spawn 'team/late' does nothing: it has already "
                                     "spawned 3 objects, which is its limit"});
  EXPECT_EQ(simulation.robot_count(), 4u);
}

TEST_P(Spawners, NeverReuseANameOrAnId) {
  spawn_at(10ms);
  spawn_at(20ms);
  Simulation simulation(experiment_, 1);
  step(simulation);
  simulation.act(RemoveObject{"team/late_1"});
  step(simulation);
  ASSERT_EQ(simulation.robot_count(), 3u);
  EXPECT_EQ(simulation.robot_name(2), "team/late_3");
  EXPECT_FALSE(simulation.is_present(1));
}

TEST_P(Spawners, GiveTheSameBitsForAnyThreadCountAndFromAnySnapshot) {
  spawn_at(30ms);
  spawn_on_call();
  Simulation straight(experiment_, 1);
  Simulation four(experiment_, 4);
  for (std::uint64_t saved = 0; saved < 20; ++saved) {
    Simulation restored(experiment_, 2);
    restored.restore(straight.save());
    ASSERT_EQ(restored.state_hash(), straight.state_hash()) << "tick " << saved;
    run(restored, 5);
    run(straight, 1);
    run(four, 1);
    ASSERT_EQ(four.state_hash(), straight.state_hash()) << "tick " << straight.tick();
    Simulation later(experiment_, 1);
    run(later, static_cast<int>(saved) + 5);
    ASSERT_EQ(restored.state_hash(), later.state_hash()) << "saved at tick " << saved;
  }
  EXPECT_EQ(straight.robot_count(), 4u);
}

TEST_P(Spawners, HashTheirNumberOfSpawnedObjects) {
  spawn_on_call();
  experiment_.spawners.push_back(experiment_.spawners[0]);
  description::Experiment other = experiment_;
  std::get<description::SpawnNew>(other.reactions[0].events[0].effect).spawner = 1;
  Simulation first(experiment_, 1), second(other, 1);
  run(first, 3);
  run(second, 3);
  EXPECT_EQ(first.robot_count(), second.robot_count());
  EXPECT_NE(first.state_hash(), second.state_hash()) << "another one has come to its end sooner";
}

TEST_P(Spawners, AreRejectedBeforeTheFirstStep) {
  spawn_at(0ms);
  EXPECT_THROW(Simulation(experiment_, 1), std::invalid_argument);
}

}  // namespace
}  // namespace cohort
