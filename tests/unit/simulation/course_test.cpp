// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "server/simulation/simulation.hpp"
#include "tests/support/robots.hpp"

namespace cohort {
namespace {

using namespace std::chrono_literals;
using namespace test;

description::Model loose_box(const std::string& name, double mass = 2.0, double edge = 0.2) {
  description::Model model;
  model.name = name;
  description::Inertial inertial;
  inertial.mass = mass;
  inertial.inertia = mass * edge * edge / 6.0 * Eigen::Matrix3d::Identity();
  model.links.push_back({"body", {}, inertial, {{"hull", {}, description::Box{Eigen::Vector3d::Constant(edge)}, {}}}});
  return model;
}

// Two robots, a wall, a box on the floor and one in the air.
class ScheduledRun : public ::testing::TestWithParam<description::Fidelity> {
 protected:
  ScheduledRun() {
    description::World& world = experiment_.world;
    world = world_with_floor();
    world.physics.fidelity = GetParam();
    first_ = place(world, tracked_robot(), "team/a", at(0, 0, 0));
    second_ = place(world, tracked_robot(), "team/b", at(0, 1, 0));
    wall_ = place(world, static_shape("wall", description::Box{{0.1, 4.0, 0.4}}), "wall", at(0.5, 0, 0.2));
    box_ = place(world, loose_box("box"), "things/box", at(-1, 0, 0.1));
    experiment_.duration = 10s;
    description::Team team{"team", {0, 1}, "none", {}};
    experiment_.teams.push_back(team);
  }
  void at_time(std::chrono::nanoseconds time, std::size_t object, description::Effect effect,
               const std::string& kind = "event") {
    experiment_.events.push_back({time, object, std::move(effect), kind});
  }
  static void run(Simulation& simulation, std::uint64_t ticks, double speed = 0.0) {
    for (std::uint64_t i = 0; i < ticks; ++i) {
      for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot)
        simulation.set_command(robot, std::vector<double>{speed, speed, 0.0});
      simulation.step();
    }
  }

  description::Experiment experiment_;
  std::uint32_t first_ = 0, second_ = 0, wall_ = 0, box_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Fidelities, ScheduledRun,
                         ::testing::Values(description::Fidelity::treel, description::Fidelity::planar),
                         [](const auto& tested) {
                           return tested.param == description::Fidelity::planar ? "planar" : "treel";
                         });

TEST_P(ScheduledRun, ARobotPassesARemovedWall) {
  Simulation blocked(experiment_, 1);
  run(blocked, 600, 0.15);
  EXPECT_LT(blocked.robot_pose(0).position.x(), 0.45);

  at_time(2s, wall_, description::SetPresence{false});
  Simulation open(experiment_, 1);
  run(open, 600, 0.15);
  EXPECT_NEAR(open.robot_pose(0).position.x(), 6.0 * 0.15, 0.1);
  EXPECT_FALSE(open.objects().is_present(wall_));
}

TEST_P(ScheduledRun, ARobotIsBlockedByAWallThatReturns) {
  at_time(0s, wall_, description::SetPresence{false});
  at_time(1s, wall_, description::SetPresence{true});
  Simulation simulation(experiment_, 1);
  run(simulation, 600, 0.15);
  EXPECT_LT(simulation.robot_pose(0).position.x(), 0.45);
}

TEST_P(ScheduledRun, ALaterRobotIsNeitherControlledNorSensedBefore) {
  experiment_.world.instances[second_].is_present = false;
  experiment_.world.instances[second_].X_WM = at(0.2, 0, 0);  // right in front of the first one
  at_time(50ms, second_, description::SetPresence{true, true});
  Simulation simulation(experiment_, 1);
  const auto sees_something = [&] {
    const auto values = simulation.observation(0);
    return std::any_of(values.end() - 15, values.end(), [](double reading) { return reading > 0.3; });
  };
  EXPECT_FALSE(simulation.is_present(1));
  EXPECT_FALSE(sees_something());
  run(simulation, 4);
  EXPECT_FALSE(simulation.is_present(1));
  EXPECT_FALSE(sees_something());
  run(simulation, 1);
  EXPECT_TRUE(simulation.is_present(1));
  EXPECT_TRUE(sees_something());
  EXPECT_EQ(simulation.touches().robot_ticks, 5u);  // counted before the event of the boundary
  EXPECT_EQ(simulation.happened(), std::vector<std::string>{"event 'team/b'"});
}

TEST_P(ScheduledRun, AMovedObjectIsAtRest) {
  at_time(20ms, box_, description::SetVelocity{{1.0, 0, 0}, Eigen::Vector3d::Zero()});
  at_time(100ms, box_, description::PlaceAt{at(3, 2, 0.1, 0.5)});
  Simulation simulation(experiment_, 1);
  run(simulation, 10);
  EXPECT_LT((simulation.object_pose(box_).position - Eigen::Vector3d(3, 2, 0.1)).norm(), 1e-12);
  EXPECT_NEAR(
      2.0 * std::atan2(simulation.object_pose(box_).orientation.z(), simulation.object_pose(box_).orientation.w()), 0.5,
      1e-12);
  run(simulation, 100);
  EXPECT_LT((simulation.object_pose(box_).position - Eigen::Vector3d(3, 2, 0.1)).norm(), 1e-3);
}

TEST_P(ScheduledRun, AMovedStaticObjectBlocksItsNewPlace) {
  at_time(10ms, wall_, description::PlaceAt{at(1.0, 0, 0.2)});
  Simulation simulation(experiment_, 1);
  run(simulation, 900, 0.15);
  EXPECT_GT(simulation.robot_pose(0).position.x(), 0.85);
  EXPECT_LT(simulation.robot_pose(0).position.x(), 0.95);
}

TEST_P(ScheduledRun, AForceAcceleratesAMass) {
  experiment_.world.gravity = {0, 0, GetParam() == description::Fidelity::planar ? -1e-9 : 0.0};
  const double mass = 2.0, force = 3.0;
  at_time(100ms, box_, description::ApplyForce{0, {force, 0, 0}, Eigen::Vector3d::Zero(), 500ms});
  Simulation simulation(experiment_, 1);
  run(simulation, 10);
  EXPECT_NEAR(simulation.world().link_twist(BodyId{box_}, LinkId{0}).linear_W.x(), 0.0, 1e-9);
  run(simulation, 100);
  EXPECT_NEAR(simulation.world().link_twist(BodyId{box_}, LinkId{0}).linear_W.x(), force / mass * 0.5, 1e-6);
}

TEST_P(ScheduledRun, ATorqueRotatesABody) {
  experiment_.world.gravity = {0, 0, GetParam() == description::Fidelity::planar ? -1e-9 : 0.0};
  const double inertia = 2.0 * 0.2 * 0.2 / 6.0, torque = 0.01;
  at_time(0s, box_, description::ApplyForce{0, Eigen::Vector3d::Zero(), {0, 0, torque}, 200ms});
  Simulation simulation(experiment_, 1);
  run(simulation, 50);
  EXPECT_NEAR(simulation.world().link_twist(BodyId{box_}, LinkId{0}).angular_W.z(), torque / inertia * 0.2, 1e-6);
}

TEST_P(ScheduledRun, StopsWhenAllHaveBeenInsideForTheGivenTime) {
  experiment_.stops.push_back({"inside", {first_, second_}, description::AllInside{{0.2, -1}, {1, 2}}, 100ms});
  Simulation simulation(experiment_, 1);
  std::uint64_t entered = 0;
  while (!simulation.stop_reason() && simulation.tick() < 1000) {
    run(simulation, 1, 0.1);
    const bool inside = simulation.robot_pose(0).position.x() >= 0.2 && simulation.robot_pose(1).position.x() >= 0.2;
    if (inside && entered == 0) entered = simulation.tick();
  }
  ASSERT_TRUE(simulation.stop_reason());
  EXPECT_EQ(*simulation.stop_reason(), "inside: 2 objects");
  EXPECT_EQ(simulation.tick(), entered + 10);
}

TEST_P(ScheduledRun, StopsWhenAnObjectCrossesALineAndNamesIt) {
  experiment_.stops.push_back({"beyond", {first_, second_}, description::OneBeyond{{0, 1.2}, {0, 1}}, 0s});
  at_time(1s, second_, description::PlaceAt{at(0, 1.3, 0)});
  Simulation simulation(experiment_, 1);
  run(simulation, 99);
  EXPECT_FALSE(simulation.stop_reason());
  run(simulation, 1);
  EXPECT_EQ(simulation.stop_reason(), "beyond: 'team/b'");
}

TEST_P(ScheduledRun, StopsWhenNothingMoves) {
  experiment_.stops.push_back({"at_rest", {first_, second_, box_}, description::AllAtRest{0.001, 0.01}, 200ms});
  Simulation simulation(experiment_, 1);
  run(simulation, 50, 0.1);
  EXPECT_FALSE(simulation.stop_reason());
  run(simulation, 100);
  EXPECT_EQ(simulation.stop_reason(), "at_rest: 3 objects");
}

TEST(StopConditions, NameTheQuarantinedBody) {
  description::Experiment experiment;
  experiment.world = world_with_floor();
  experiment.world.physics.lowest = -1.0;
  const std::uint32_t box = place(experiment.world, loose_box("box"), "box", at(0, 0, -0.9));
  experiment.stops.push_back({"quarantined", {box}, description::OneQuarantined{}, 0s});
  experiment.world.gravity = {0, 0, -9.81};
  experiment.world.instances[0].X_WM.position.z() = -20.0;  // the floor
  Simulation simulation(experiment, 1);
  for (int i = 0; i < 100 && !simulation.stop_reason(); ++i) simulation.step();
  EXPECT_EQ(simulation.stop_reason(), "quarantined: 'box'");
}

TEST_P(ScheduledRun, KeepsTheLastPosesOfRequestedObjects) {
  experiment_.history = {{first_, box_}, 5, 20ms};
  Simulation simulation(experiment_, 1);
  run(simulation, 31, 0.1);
  const auto& history = simulation.objects().history(first_);
  ASSERT_EQ(history.size(), 5u);
  EXPECT_EQ(history.front().tick, 22u);
  EXPECT_EQ(history.back().tick, 30u);
  EXPECT_LT(history.front().X_WL.position.x(), history.back().X_WL.position.x());
  EXPECT_TRUE(simulation.objects().history(second_).empty());
}

TEST_P(ScheduledRun, HasAHierarchyOfObjectsThatGrowsAndShrinks) {
  Simulation simulation(experiment_, 1);
  EXPECT_EQ(simulation.objects().find("things/box"), box_);
  const std::string& model = experiment_.world.models[experiment_.world.instances[box_].model].name;
  simulation.act(SpawnObject{"things/another", model, at(-1, 1, 0.1)});
  const std::uint32_t added = *simulation.objects().find("things/another");
  EXPECT_EQ(added, simulation.objects().size() - 1);
  EXPECT_THROW(simulation.act(SpawnObject{"things/box", model, at(-1, 2, 0.1)}), std::invalid_argument);
  run(simulation, 10);
  EXPECT_TRUE(simulation.objects().is_present(added));
  EXPECT_NEAR(simulation.object_pose(added).position.z(), 0.1, 1e-3);
  const std::uint64_t before = simulation.state_hash();
  simulation.act(RemoveObject{"things/another"});
  EXPECT_NE(simulation.state_hash(), before);
  EXPECT_FALSE(simulation.objects().is_present(added));
}

// ---- Guarantees ----

class EventfulRun : public ScheduledRun {
 protected:
  EventfulRun() {
    experiment_.world.instances[second_].is_present = false;
    at_time(50ms, second_, description::SetPresence{true, true});
    at_time(100ms, wall_, description::SetPresence{false});
    at_time(150ms, box_, description::ApplyForce{0, {40, 5, 0}, {0, 0, 0.5}, 300ms});
    at_time(200ms, wall_, description::PlaceAt{at(0.3, 0, 0.2, 0.2)});
    at_time(250ms, wall_, description::SetPresence{true});
    at_time(300ms, first_, description::PlaceAt{at(-0.5, 0.5, 0, 1.0)});
    at_time(350ms, second_, description::SetPresence{false});
    at_time(500ms, second_, description::SetPresence{true});
    at_time(600ms, box_, description::SetVelocity{{0.5, 0.5, 0}, {0, 0, 1}});
    experiment_.stops.push_back({"at_rest", {box_}, description::AllAtRest{1e-6, 1e-6}, 10s});
    experiment_.history = {{first_, box_}, 7, 30ms};
  }
};

INSTANTIATE_TEST_SUITE_P(Fidelities, EventfulRun,
                         ::testing::Values(description::Fidelity::treel, description::Fidelity::planar),
                         [](const auto& tested) {
                           return tested.param == description::Fidelity::planar ? "planar" : "treel";
                         });

TEST_P(EventfulRun, GivesTheSameBitsWithAnyNumberOfThreads) {
  Simulation one(experiment_, 1);
  Simulation four(experiment_, 4);
  for (int i = 0; i < 90; ++i) {
    run(one, 1, 0.1);
    run(four, 1, 0.1);
    ASSERT_EQ(one.state_hash(), four.state_hash()) << "tick " << one.tick();
  }
}

TEST_P(EventfulRun, GivesTheSameBitsFromASnapshotOfAnyTick) {
  Simulation straight(experiment_, 1);
  const std::string& model = experiment_.world.models[experiment_.world.instances[box_].model].name;
  for (std::uint64_t saved = 0; saved < 80; saved += 7) {
    if (saved == 7) straight.act(SpawnObject{"extra", model, at(-1, 2, 0.1)});
    Simulation restored(experiment_, 1);
    restored.restore(straight.save());
    ASSERT_EQ(restored.state_hash(), straight.state_hash()) << "tick " << saved;
    EXPECT_EQ(restored.save(), straight.save());
    EXPECT_EQ(restored.objects().find("extra"), straight.objects().find("extra"));
    run(straight, 7, 0.1);
    run(restored, 7, 0.1);
    ASSERT_EQ(restored.state_hash(), straight.state_hash()) << "saved at tick " << saved;
  }
}

}  // namespace
}  // namespace cohort
