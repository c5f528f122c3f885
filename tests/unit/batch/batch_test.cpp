// SPDX-License-Identifier: Apache-2.0
#include "server/batch/batch.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include "tests/support/robots.hpp"

namespace cohort {
namespace {

using namespace std::chrono_literals;
using namespace test;

// A robot that drives on a floor, and one that has a turret alone.
description::Experiment two_kinds() {
  description::Experiment experiment;
  experiment.world = world_with_floor();
  description::Model other = tracked_robot();
  other.name = "other";
  std::erase_if(other.devices, [](const description::Device& device) {
    return !std::holds_alternative<description::VelocityMotor>(device);
  });
  place(experiment.world, tracked_robot(0.1), "team/a", at(0, 0, 0));
  place(experiment.world, other, "team/b", at(0, 1, 0));
  experiment.duration = 100ms;
  experiment.teams.push_back({"team", {0, 1}, "", {}});
  return experiment;
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(Batch, HasARowForEachRobotOfEachWorldAsLongAsTheLongest) {
  Batch batch(two_kinds(), 3, 1);
  ASSERT_EQ(batch.kinds().size(), 2u);
  EXPECT_EQ(batch.observation_size(), batch.kinds()[0].observation_size);
  EXPECT_EQ(batch.command_size(), 3u);
  EXPECT_EQ(batch.kinds()[1].command_size, 1u);
  EXPECT_EQ(batch.observations().size(), 3 * 2 * batch.observation_size());
  EXPECT_EQ(batch.commands().size(), 3u * 2 * 3);
  EXPECT_EQ(batch.poses().size(), 3u * 2 * 7);
  EXPECT_EQ(batch.done().size(), 3u);
  batch.step();
  const std::span<const double> of_turret = batch.observations().subspan(batch.observation_size());
  for (std::size_t i = batch.kinds()[1].observation_size; i < batch.observation_size(); ++i) EXPECT_EQ(of_turret[i], 0);
}

TEST(Batch, KeepsTheAddressesOfItsArrays) {
  Batch batch(two_kinds(), 2, 1);
  const auto addresses = [&] {
    return std::tuple(batch.observations().data(), batch.commands().data(), batch.poses().data(), batch.done().data());
  };
  const auto before = addresses();
  batch.step(20);
  batch.reset(1, 5);
  batch.step();
  EXPECT_EQ(addresses(), before);
}

TEST(Batch, ShowsWhatASimulationWithTheSameCommandsShows) {
  Batch batch(two_kinds(), 2, 1);
  Simulation alone(two_kinds(), 1);
  const std::vector<double> drive{0.1, 0.05, 0.3};
  std::ranges::copy(drive, batch.commands().subspan(6).begin());  // commands of world 1
  alone.set_command(0, drive);
  batch.step(4);
  batch.step();
  for (int i = 0; i < 5; ++i) alone.step();
  EXPECT_EQ(batch.hash(1), alone.state_hash());
  EXPECT_NE(batch.hash(0), alone.state_hash());
  const std::span<const double> shown = batch.observations().subspan(2 * batch.observation_size());
  EXPECT_TRUE(std::ranges::equal(alone.observation(0), shown.first(alone.observation(0).size())));
  const Pose X_WL = alone.robot_pose(0);
  const std::span<const double> pose = batch.poses().subspan(14, 7);
  EXPECT_GT(pose[0], 0.001);
  EXPECT_EQ(pose[0], X_WL.position.x());
  EXPECT_EQ(pose[3], X_WL.orientation.w());
  EXPECT_EQ(pose[6], X_WL.orientation.z());
}

TEST(Batch, RefusesACommandByWorldRobotAndChannelBeforeAnythingMoves) {
  Batch batch(two_kinds(), 3, 2);
  const std::uint64_t before = batch.hash(0);
  batch.commands()[2 * 6 + 2] = 9.0;
  EXPECT_EQ(message_of([&] { batch.step(); }), "world 2: team/a: turret/0/velocity is 9 rad/s, expected -1.5 to 1.5");
  batch.commands()[2 * 6 + 2] = 0.0;
  batch.commands()[1 * 6 + 3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message_of([&] { batch.step(); }), "world 1: team/b: turret/0/velocity is nan rad/s, expected -1.5 to 1.5");
  EXPECT_EQ(batch.hash(0), before);
  EXPECT_EQ(batch.tick(0), 0u);
  batch.commands()[1 * 6 + 3] = 0.0;
  batch.commands()[1 * 6 + 5] = 99.0;  // behind the channels of its robot
  batch.step();
  EXPECT_EQ(batch.tick(0), 1u);
}

TEST(Batch, SaysWhatIsAskedForInVain) {
  EXPECT_EQ(message_of([] { Batch(two_kinds(), 0, 1); }), "a batch needs at least one world");
  Batch batch(two_kinds(), 2, 1);
  EXPECT_EQ(message_of([&] { batch.reset(2, 1); }), "there is no world 2, expected one of 0 to 1");
  EXPECT_EQ(message_of([&] { batch.step(0); }), "expected at least one tick");
  const std::vector<Pose> poses(2);
  EXPECT_EQ(message_of([&] { batch.reset(0, 1, poses); }),
            "got 2 poses, expected one for each of the 3 objects of the experiment");
}

TEST(Batch, AWorldWhoseDurationIsOverStandsStillUntilItIsReset) {
  Batch batch(two_kinds(), 2, 1);
  batch.step(4);
  batch.reset(1, 2);
  EXPECT_EQ(batch.done()[0], 0);
  batch.step(8);
  EXPECT_EQ(batch.tick(0), 10u);
  EXPECT_EQ(batch.done()[0], Batch::timed_out);
  EXPECT_EQ(batch.tick(1), 8u);
  EXPECT_EQ(batch.done()[1], 0);
  const std::uint64_t at_end = batch.hash(0);
  batch.step();
  EXPECT_EQ(batch.hash(0), at_end);
  batch.reset(0, 3);
  EXPECT_EQ(batch.done()[0], 0);
  batch.step();
  EXPECT_EQ(batch.tick(0), 1u);
}

TEST(Batch, AResetPutsNeutralCommandsAndTheFirstObservations) {
  Batch batch(two_kinds(), 2, 1);
  const std::vector<double> first(batch.observations().begin(), batch.observations().end());
  batch.commands()[0] = 0.1;
  batch.step(3);
  EXPECT_FALSE(std::ranges::equal(batch.observations(), first));
  batch.reset(0, 1);
  EXPECT_EQ(batch.commands()[0], 0.0);
  batch.reset(1, 1);
  EXPECT_TRUE(std::ranges::equal(batch.observations(), first));
}

TEST(Batch, ARobotIsWhereAResetPutsIt) {
  Batch batch(two_kinds(), 2, 1);
  std::vector<Pose> poses;
  for (const description::Instance& instance : two_kinds().world.instances) poses.push_back(instance.X_WM);
  poses[1] = at(0.5, 0.25, 0, 1.0);
  batch.reset(1, 7, poses);
  description::Experiment there = two_kinds();
  there.seed = 7;
  there.world.instances[1].X_WM = poses[1];
  EXPECT_EQ(batch.hash(1), Simulation(there, 1).state_hash());
  EXPECT_EQ(batch.poses()[14], Simulation(there, 1).robot_pose(0).position.x());
  EXPECT_EQ(batch.hash(0), Simulation(two_kinds(), 1).state_hash());
}

TEST(Batch, AStopConditionEndsAWorldAtItsTick) {
  description::Experiment experiment = two_kinds();
  experiment.stops.push_back({"line", {1}, description::OneBeyond{{0.002, 0}, {1, 0}}, 0ns});
  Batch batch(experiment, 2, 1);
  batch.commands()[0] = batch.commands()[1] = 0.1;
  batch.step(9);
  EXPECT_EQ(batch.done()[0], Batch::stopped);
  EXPECT_LT(batch.tick(0), 9u);
  EXPECT_GT(batch.poses()[0], 0.002);
  EXPECT_EQ(batch.done()[1], 0);
  EXPECT_EQ(batch.tick(1), 9u);
}

// Its shape and surface are kept once for all worlds.
TEST(Batch, APostTakesLessThanHalfAKibibyteOfEachWorld) {
  constexpr std::size_t posts = 64, worlds = 64;
  const auto heap = [] { return static_cast<double>(mallinfo2().uordblks + mallinfo2().hblkhd); };
  const auto bytes_a_world = [&](const description::Experiment& experiment) {
    const Batch one(experiment, 1, 1);
    const double before = heap();
    const Batch many(experiment, worlds, 1);
    return (heap() - before) / worlds;
  };
  for (const auto fidelity : {description::Fidelity::treel, description::Fidelity::planar}) {
    description::Experiment experiment = two_kinds();
    experiment.world.physics.fidelity = fidelity;
    const double without = bytes_a_world(experiment);
    description::Model post = static_shape("post", description::Cylinder{0.05, 0.15});
    const std::size_t model = experiment.world.models.size();
    experiment.world.models.push_back(post);
    for (std::size_t i = 0; i < posts; ++i)
      experiment.world.instances.push_back(
          {"posts/" + std::to_string(i), model,
           at(0.2 * static_cast<double>(i % 8) - 5.0, 0.2 * static_cast<double>(i / 8), 0.075)});
    EXPECT_LT(bytes_a_world(experiment) - without, 512.0 * posts);
  }
}

TEST(Batch, NothingGrowsWithResets) {
  Batch batch(two_kinds(), 4, 1);
  const auto allocated = [] { return mallinfo2().uordblks; };
  std::size_t before = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    if (i == 1000) before = allocated();
    batch.reset(i % 4, i);
    if (i % 100 == 99) batch.step(2);
  }
  EXPECT_LE(allocated(), before + 4096);
}

TEST(Batch, RefusesEventsThatSpawn) {
  description::Experiment experiment = two_kinds();
  experiment.spawners.push_back({"late", 0, at(2, 0, 0), {1, 1}, "team", 1});
  experiment.events.push_back({30ms, 0, description::SpawnNew{0}, "spawn"});
  EXPECT_NE(message_of([&] { Batch(experiment, 2, 1); }).find("an event spawns 'late_1'"), std::string::npos);
}

// The robot falls beside the floor that is taken away.
description::Experiment without_ground(bool strict) {
  description::Experiment experiment = two_kinds();
  experiment.world.physics.lowest = -0.01;
  experiment.world.physics.strict = strict;
  experiment.duration = 1s;
  experiment.events.push_back({20ms, 0, description::SetPresence{false}, "remove"});
  return experiment;
}

TEST(Batch, ShowsThatARobotIsQuarantinedAndGoesOn) {
  Batch batch(without_ground(false), 2, 1);
  batch.step(50);
  EXPECT_EQ(batch.done()[0], Batch::quarantined);
  EXPECT_EQ(batch.tick(0), 50u);
}

TEST(Batch, AWorldThatFailsIsNamedAndTheOthersGoOn) {
  Batch batch(without_ground(true), 3, 2);
  batch.step(1);
  batch.reset(0, 1);
  batch.reset(2, 1);
  std::string message;
  std::uint64_t steps = 1;
  for (; message.empty() && steps < 100; ++steps) message = message_of([&] { batch.step(); });
  EXPECT_EQ(message, "world 1: 'team/b' has left the world");
  EXPECT_EQ(batch.done()[1] & Batch::failed, Batch::failed);
  EXPECT_EQ(batch.done()[0], 0);
  EXPECT_EQ(batch.tick(2), steps - 1);
  batch.reset(1, 1);
  EXPECT_EQ(batch.done()[1], 0);
  EXPECT_EQ(batch.tick(1), 0u);
}

TEST(Batch, OfWorldsThatFailAtOnceTheFirstIsNamedAndAllStandStill) {
  Batch batch(without_ground(true), 3, 1);
  std::string message;
  for (int step = 0; step < 100 && message.empty(); ++step) message = message_of([&] { batch.step(); });
  EXPECT_EQ(message, "world 0: 'team/b' has left the world");
  for (const std::uint8_t done : batch.done()) EXPECT_EQ(done & Batch::failed, Batch::failed);
  EXPECT_EQ(message_of([&] { batch.step(); }), "");
}

}  // namespace
}  // namespace cohort
