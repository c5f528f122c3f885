// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <ctime>

#include "server/simulation/simulation.hpp"
#include "tests/support/worlds/model_text.hpp"
#include "tests/support/worlds/small_world.hpp"

/// Objects that are spawned and removed: the next object of the same model takes the memory of one that is gone.
namespace cohort {
namespace {

using namespace test;

// With emitters, a gripper, and sensors that remember.
description::Model busy_robot() {
  description::Model model = tracked_robot();
  auto& ring = std::get<description::ProximityRing>(model.devices.back());
  description::Noise noise;
  noise.deviation = 0.01;
  noise.drift_deviation = 0.1;
  noise.drift_time = 1.0;
  ring.readout.noises = {noise};
  ring.readout.latency = std::chrono::milliseconds(30);
  model.devices.push_back(description::RangeAndBearing{"rab", 1, {{0, 0, 0.03}}, 2.0, 2, 4, {}});
  model.devices.push_back(description::Battery{"battery", 100.0});
  model.devices.push_back(description::Gripper{.name = "gripper", .link = 0, .X_LG = {}});
  model.devices.push_back(description::UserAction{"call"});
  model.emitters.push_back({"top", 0, {{0, 0, 0.1}}, true, description::Light{}});
  return model;
}

description::Model post() {
  description::Model model = static_shape("post", description::Box{{0.1, 0.1, 0.4}});
  model.emitters.push_back({"hum", 0, {}, true, description::Sound{440.0}});
  return model;
}

class ComingAndGoing : public ::testing::TestWithParam<description::Fidelity> {
 protected:
  ComingAndGoing() {
    description::World& world = experiment_.world;
    world = world_with_floor();
    world.physics.fidelity = GetParam();
    place(world, busy_robot(), "team/a", at(0, 0, 0));
    place(world, post(), "post", at(0.4, 0.05, 0.2));
    place(
        world,
        loose("box", description::Box{Eigen::Vector3d::Constant(0.1)}, solid_box(0.2, Eigen::Vector3d::Constant(0.1))),
        "box", at(-1, 0, 0.05));
    experiment_.seed = 5;
    experiment_.read_model = model_of_text;
    experiment_.teams.push_back({"team", {0}, "none", {}});
  }
  static void drive(Simulation& simulation, int steps) {
    for (; steps > 0; --steps) {
      for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
        std::vector<double> command(simulation.command(robot).begin(), simulation.command(robot).end());
        if (command.empty()) continue;
        command[0] = 0.1;
        command[1] = 0.08;
        simulation.set_command(robot, command);
      }
      simulation.step();
    }
  }
  static std::uint32_t object(const Simulation& simulation, const std::string& name) {
    return *simulation.objects().find(name);
  }
  static void spawn(Simulation& simulation, const std::string& name, const std::string& model, const Pose& X_WM) {
    simulation.act(SpawnObject{name, model, X_WM});
  }

  description::Experiment experiment_;
};

INSTANTIATE_TEST_SUITE_P(Fidelities, ComingAndGoing,
                         ::testing::Values(description::Fidelity::treel, description::Fidelity::planar),
                         [](const auto& tested) {
                           return tested.param == description::Fidelity::planar ? "planar" : "treel";
                         });

TEST_P(ComingAndGoing, KeepsNothingOfTheirBodies) {
  Simulation simulation(experiment_, 1);
  for (int cycle = 0; cycle < 5; ++cycle) {
    const std::string number = std::to_string(cycle);
    spawn(simulation, "team/new_" + number, "tracked_robot", at(1, 1, 0));
    spawn(simulation, "post_" + number, "post", at(2, 0, 0.2));
    spawn(simulation, "box_" + number, "box", at(3, 0, 0.05));
    drive(simulation, 3);
    const std::uint32_t robot = simulation.robot_count() - 1;
    EXPECT_TRUE(simulation.is_present(robot));
    EXPECT_FALSE(simulation.observation(robot).empty());
    for (const std::string name : {"team/new_", "post_", "box_"}) simulation.act(RemoveObject{name + number});
    EXPECT_FALSE(simulation.is_present(robot));
    EXPECT_TRUE(simulation.observation(robot).empty());
    EXPECT_TRUE(simulation.command(robot).empty());
    EXPECT_FALSE(simulation.set_neutral_command(robot));
  }
  Simulation one_cycle(experiment_, 1);
  spawn(one_cycle, "team/new", "tracked_robot", at(1, 1, 0));
  spawn(one_cycle, "post_0", "post", at(2, 0, 0.2));
  spawn(one_cycle, "box_0", "box", at(3, 0, 0.05));
  EXPECT_EQ(simulation.world().scene().size(), one_cycle.world().scene().size());
  EXPECT_EQ(simulation.emitters().lamps().size(), one_cycle.emitters().lamps().size());
  EXPECT_EQ(simulation.emitters().tones().size(), one_cycle.emitters().tones().size());
  EXPECT_EQ(simulation.grippers().size(), one_cycle.grippers().size());
  EXPECT_EQ(simulation.robot_name(4), "team/new_3") << "ids and names are not reused";
}

TEST_P(ComingAndGoing, LeavesTheLastPoseOfARemovedObject) {
  Simulation simulation(experiment_, 1);
  spawn(simulation, "team/new", "tracked_robot", at(1, 1, 0));
  drive(simulation, 20);
  const Pose last = simulation.robot_pose(1);
  simulation.act(RemoveObject{"team/new"});
  spawn(simulation, "team/newer", "tracked_robot", at(2, 1, 0));
  drive(simulation, 5);
  EXPECT_LT((simulation.robot_pose(1).position - last.position).norm(), 1e-12);
  EXPECT_GT((simulation.robot_pose(2).position - last.position).norm(), 0.9);
}

// Nothing that was done to the removed robot affects the next one.
TEST_P(ComingAndGoing, MakesANewRobotWithTheSameBitsInUsedMemory) {
  const auto last_observations = [&](bool after_another) {
    Simulation simulation(experiment_, 1);
    if (after_another) spawn(simulation, "team/before", "tracked_robot", at(0.3, 0.4, 0));
    if (after_another) spawn(simulation, "box_before", "box", at(0.4, 0.4, 0.05));
    if (after_another) simulation.act(SetLight{"team/before/top", false, 0.5});
    drive(simulation, after_another ? 12 : 0);
    if (after_another) simulation.act(SetVelocity{"team/before", {0.1, 0.2, 0}, {0, 0, 1}});
    drive(simulation, after_another ? 0 : 12);
    if (after_another) simulation.act(RemoveObject{"team/before"});
    if (after_another) simulation.act(RemoveObject{"box_before"});
    // The others are put where they are in both.
    simulation.act(SetPose{"team/a", at(0, 0, 0)});
    spawn(simulation, "team/new", "tracked_robot", at(0.3, -0.4, 0));
    spawn(simulation, "box_new", "box", at(0.4, -0.4, 0.05));
    std::vector<double> seen;
    for (int tick = 0; tick < 40; ++tick) {
      drive(simulation, 1);
      const auto values = simulation.observation(simulation.robot_count() - 1);
      seen.insert(seen.end(), values.begin(), values.end());
      const Pose X_WL = simulation.robot_pose(simulation.robot_count() - 1);
      seen.insert(seen.end(), X_WL.position.begin(), X_WL.position.end());
    }
    EXPECT_TRUE(simulation.emitters().lamps().back().is_on);
    return seen;
  };
  EXPECT_EQ(last_observations(true), last_observations(false));
}

TEST_P(ComingAndGoing, IsRestoredWithTheSameMemory) {
  Simulation simulation(experiment_, 1);
  drive(simulation, 3);
  spawn(simulation, "team/b", "tracked_robot", at(1, 0, 0));
  spawn(simulation, "team/c", "tracked_robot", at(1, 0.4, 0));
  spawn(simulation, "post_b", "post", at(2, 0, 0.2));
  spawn(simulation, "box_b", "box", at(2, 1, 0.05));
  drive(simulation, 3);
  simulation.act(RemoveObject{"team/c"});
  spawn(simulation, "team/d", "tracked_robot", at(1, -0.4, 0));  // in the memory of c
  simulation.act(RemoveObject{"team/b"});
  simulation.act(RemoveObject{"post_b"});
  simulation.act(RemoveObject{"box_b"});
  drive(simulation, 5);
  const std::vector<std::byte> snapshot = simulation.save();
  Simulation restored(experiment_, 2);
  restored.restore(snapshot);
  EXPECT_EQ(restored.state_hash(), simulation.state_hash());
  EXPECT_TRUE(restored.save() == snapshot);
  for (Simulation* const each : {&simulation, &restored}) {
    spawn(*each, "team/e", "tracked_robot", at(1, 0, 0));  // in the memory of b
    spawn(*each, "post_e", "post", at(1.3, 0, 0.2));
    spawn(*each, "team/f", "tracked_robot", at(1, 0.4, 0));
    drive(*each, 30);
  }
  EXPECT_EQ(restored.state_hash(), simulation.state_hash());
  EXPECT_EQ(restored.world().scene().size(), simulation.world().scene().size());
}

TEST_P(ComingAndGoing, IsHashedTheSameWhetherOrNotItWasHashedBefore) {
  const auto hash_at_the_end = [&](bool is_hashed_before) {
    Simulation simulation(experiment_, 1);
    spawn(simulation, "team/b", "tracked_robot", at(1, 0, 0));
    if (is_hashed_before) simulation.state_hash();
    simulation.act(RemoveObject{"team/b"});
    return simulation.state_hash();
  };
  EXPECT_EQ(hash_at_the_end(true), hash_at_the_end(false));
}

// A snapshot may come from anywhere: bytes of the slots that do not fit are refused.
TEST_P(ComingAndGoing, RefusesASnapshotWhoseSlotsDoNotFit) {
  Simulation simulation(experiment_, 1);
  spawn(simulation, "box_b", "box", at(2, 1, 0.05));
  const std::vector<std::byte> snapshot = simulation.save();
  const std::string name = "box_b";
  const auto found = std::search(snapshot.begin(), snapshot.end(), name.begin(), name.end(),
                                 [](std::byte a, char b) { return a == static_cast<std::byte>(b); });
  ASSERT_NE(found, snapshot.end());
  const auto slot = static_cast<std::size_t>(found - snapshot.begin()) + name.size() + sizeof(std::uint64_t) + 56;
  ASSERT_EQ(snapshot.at(slot), static_cast<std::byte>(4)) << "after the floor, the robot, the post and the box";
  for (const int wrong : {0, 1, 3, 5, 255}) {
    std::vector<std::byte> changed = snapshot;
    changed[slot] = static_cast<std::byte>(wrong);
    Simulation restored(experiment_, 1);
    EXPECT_THROW(restored.restore(changed), SnapshotError) << wrong;
  }
}

// The time of a cycle and the memory stay what they were: only a name, a pose and some numbers are kept.
class ManyCycles : public ComingAndGoing {
 protected:
  static std::size_t bytes_in_use() {
    const auto info = mallinfo2();
    return info.uordblks + info.hblkhd;
  }
};

INSTANTIATE_TEST_SUITE_P(Fidelities, ManyCycles,
                         ::testing::Values(description::Fidelity::treel, description::Fidelity::planar),
                         [](const auto& tested) {
                           return tested.param == description::Fidelity::planar ? "planar" : "treel";
                         });

TEST_P(ManyCycles, OfThirtyThousandSpawnedAndRemovedRobotsCostTheSame) {
  constexpr int cycles = 30'000, part = 1'000;
  Simulation simulation(experiment_, 1);
  std::vector<double> seconds;
  std::size_t bytes_at_first = 0;
  for (int done = 0; done < cycles; done += part) {
    const std::clock_t begin = std::clock();
    for (int cycle = done; cycle < done + part; ++cycle) {
      const std::string name = "team/new_" + std::to_string(cycle);
      spawn(simulation, name, "tracked_robot", at(1, 1, 0));
      simulation.step();
      simulation.act(RemoveObject{name});
    }
    seconds.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    if (done == 0) bytes_at_first = bytes_in_use();
  }
  const double kept = static_cast<double>(bytes_in_use() - bytes_at_first) / (cycles - part);
  RecordProperty("bytes_kept_a_cycle", std::to_string(kept));
  std::cout << kept << " bytes kept a cycle, CPU time of the last thousand " << seconds.back() / seconds.front()
            << " of that of the first\n";
  EXPECT_LT(kept, 800.0);
  EXPECT_LT(*std::min_element(seconds.end() - 5, seconds.end()),
            2.0 * *std::max_element(seconds.begin(), seconds.begin() + 5));
}

}  // namespace
}  // namespace cohort
