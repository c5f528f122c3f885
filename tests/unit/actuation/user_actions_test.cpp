// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/worlds/sensing_world.hpp"
#include "tests/support/worlds/small_world.hpp"

/// Tests actions of robots that have no joint, and their reactions.
namespace cohort {
namespace {

using namespace std::chrono_literals;
using namespace test;
using description::Effect;
using Sentences = std::vector<std::string>;

// Two robots that can open a gate, and a box.
class UserActions : public ::testing::Test {
 protected:
  UserActions() {
    description::Model robot = tracked_robot();
    robot.devices.push_back(description::UserAction{"open"});
    robot.devices.push_back(description::UserAction{"call"});
    world_.add(robot, "a", at(0, 0, 0));
    world_.add(robot, "b", at(0, 1, 0));
    gate_ = world_.add(static_shape("gate", description::Box{{0.1, 1.0, 0.4}}), "gate", at(0.5, 0, 0.2));
    box_ = world_.add(loose("box", description::Box{{0.2, 0.2, 0.2}}, solid_box(2.0, Eigen::Vector3d::Constant(0.2))),
                      "box", at(-1, 0, 0.1));
  }
  void react(const std::string& action, std::vector<std::uint32_t> robots, std::size_t object, Effect effect,
             const std::string& kind) {
    world_.experiment.reactions.push_back({action, std::move(robots), {{0ns, object, std::move(effect), kind}}});
  }
  void close_gate_when_opened(std::vector<std::uint32_t> robots = {0, 1}) {
    react("open", std::move(robots), gate_, description::SetPresence{false}, "disable");
  }
  // Returns the events of the step in which the robot commands this.
  Sentences step_with(double value, std::uint32_t robot = 0, const std::string& action = "open") {
    world_.command(robot, action + "/0/value", {value});
    world_.step();
    return world_.simulation().happened();
  }
  bool has_gate() { return world_.simulation().objects().is_present(gate_); }
  double speed_of_box() { return world_.simulation().world().link_twist(BodyId{box_}, LinkId{0}).linear_W.x(); }

  SensingWorld world_;
  std::uint32_t gate_ = 0, box_ = 0;
};

TEST_F(UserActions, HaveAChannelFromNothingToOne) {
  const std::vector<Channel>& command = world_.simulation().kinds()[0].command;
  ASSERT_EQ(command[command.size() - 2].name, "open/0/value");
  EXPECT_EQ(command.back().lower, 0.0);
  EXPECT_EQ(command.back().upper, 1.0);
  EXPECT_EQ(command.back().neutral, 0.0);
}

TEST_F(UserActions, MakeEventsHappenAfterTheStepInWhichTheyRiseAndAgainOnceTheyHaveFallen) {
  close_gate_when_opened();
  world_.experiment.events.push_back({30ms, gate_, description::SetPresence{true}, "enable"});
  EXPECT_EQ(step_with(0.5), Sentences{}) << "not above a half";
  EXPECT_TRUE(has_gate());
  EXPECT_EQ(step_with(0.51), Sentences{"open of 'a': disable 'gate'"});
  EXPECT_FALSE(has_gate());
  EXPECT_EQ(step_with(1.0), Sentences{"enable 'gate'"}) << "the action goes on, and does not begin";
  EXPECT_EQ(step_with(0.5), Sentences{});
  EXPECT_TRUE(has_gate());
  EXPECT_EQ(step_with(0.7).size(), 1u);
  EXPECT_FALSE(has_gate());
}

TEST_F(UserActions, RiseForEachRobotAndActOnceAtABoundary) {
  close_gate_when_opened();
  EXPECT_EQ(step_with(1.0, 1), Sentences{"open of 'b': disable 'gate'"});
  EXPECT_EQ(step_with(1.0, 0), Sentences{"open of 'a': disable 'gate'"}) << "while the other one goes on";
  step_with(0.0, 0);
  step_with(0.0, 1);
  world_.command(1, "open/0/value", {1.0});
  EXPECT_EQ(step_with(1.0, 0), Sentences{"open of 'a' and 1 more: disable 'gate'"});
}

TEST_F(UserActions, OfOtherRobotsOrOfAnotherNameDoNothing) {
  close_gate_when_opened({1});
  EXPECT_EQ(step_with(1.0, 0), Sentences{});
  EXPECT_EQ(step_with(1.0, 1, "call"), Sentences{});
  EXPECT_TRUE(has_gate());
}

TEST_F(UserActions, OfARobotThatIsNotInTheWorldDoNothingUntilItIsBack) {
  close_gate_when_opened();
  world_.experiment.events.push_back({0ms, 1, description::SetPresence{false}, "disable"});
  world_.experiment.events.push_back({20ms, 1, description::SetPresence{true}, "enable"});
  EXPECT_EQ(step_with(1.0), Sentences{});
  EXPECT_EQ(step_with(1.0), Sentences{"enable 'a'"});
  EXPECT_EQ(step_with(1.0).size(), 1u);
}

TEST_F(UserActions, ActAfterTheEventsOfTheirTimeInTheOrderOfTheFile) {
  react("call", {0, 1}, box_, description::PlaceAt{at(-2, 0, 0.1)}, "move");
  close_gate_when_opened();
  world_.experiment.events.push_back({10ms, gate_, description::PlaceAt{at(0.7, 0, 0.2)}, "move"});
  world_.command(0, "call/0/value", {1.0});
  EXPECT_EQ(step_with(1.0), (Sentences{"move 'gate'", "call of 'a': move 'box'", "open of 'a': disable 'gate'"}));
}

TEST_F(UserActions, BringAndRemoveThingsOnceAndSayWhyNotTwice) {
  world_.world().instances[gate_].is_present = false;
  react("open", {0}, gate_, description::SetPresence{true, true}, "add");
  react("call", {0}, gate_, description::SetPresence{false, true}, "remove");
  world_.experiment.events.push_back({60ms, gate_, description::SetPresence{true}, "enable"});
  EXPECT_EQ(step_with(1.0, 0, "call"), Sentences{"call of 'a': remove 'gate' does nothing: it has not been added"});
  EXPECT_EQ(step_with(0.0, 0, "call"), Sentences{});
  EXPECT_EQ(step_with(1.0), Sentences{"open of 'a': add 'gate'"});
  EXPECT_TRUE(has_gate());
  step_with(0.0);
  EXPECT_EQ(step_with(1.0), Sentences{"open of 'a': add 'gate' does nothing: it has already been added"});
  EXPECT_EQ(step_with(1.0, 0, "call"), (Sentences{"enable 'gate'", "call of 'a': remove 'gate'"}));
  EXPECT_FALSE(has_gate());
  step_with(0.0);
  EXPECT_EQ(step_with(1.0), Sentences{"open of 'a': add 'gate' does nothing: it has been removed"});
  EXPECT_FALSE(has_gate());
}

TEST_F(UserActions, BeginAForceAnewAndDoNotAddToIt) {
  world_.world().gravity.setZero();
  const double mass = 2.0, force = 3.0, step = 0.01;
  react("open", {0, 1}, box_, description::ApplyForce{0, {force, 0, 0}, Eigen::Vector3d::Zero(), 100ms}, "apply_force");
  step_with(1.0);
  EXPECT_EQ(speed_of_box(), 0.0) << "it acts from the boundary on";
  for (int i = 0; i < 5; ++i) step_with(0.0);
  EXPECT_NEAR(speed_of_box(), force / mass * 5 * step, 1e-9);
  step_with(1.0, 1);
  for (int i = 0; i < 30; ++i) step_with(0.0, 1);
  EXPECT_NEAR(speed_of_box(), force / mass * 16 * step, 1e-9) << "six steps, then ten more";
}

TEST_F(UserActions, CallTheirHandlersInTheOrderOfTheRobotsBeforeTheEvents) {
  close_gate_when_opened();
  Simulation& simulation = world_.simulation();
  std::vector<std::pair<std::uint32_t, double>> calls;
  std::vector<std::uint64_t> ticks;
  bool gate_was_there = false;
  simulation.on_action("open", [&](std::uint32_t robot, double value) {
    calls.emplace_back(robot, value);
    ticks.push_back(simulation.tick());
    gate_was_there = has_gate();
  });
  world_.command(1, "open/0/value", {0.75});
  EXPECT_EQ(step_with(0.25), (Sentences{"open of 'b'", "open of 'b': disable 'gate'"}));
  EXPECT_EQ(calls, (std::vector<std::pair<std::uint32_t, double>>{{0, 0.25}, {1, 0.75}}));
  EXPECT_EQ(ticks, (std::vector<std::uint64_t>{1, 1}));
  EXPECT_TRUE(gate_was_there);
  calls.clear();
  simulation.act(RemoveObject{"a"});
  world_.step();
  EXPECT_EQ(calls, (std::vector<std::pair<std::uint32_t, double>>{{1, 0.75}})) << "every step, of those in the world";
  EXPECT_THROW(simulation.on_action("opn", [](std::uint32_t, double) {}), std::invalid_argument);
}

TEST_F(UserActions, LetHandlersChangeTheWorld) {
  Simulation& simulation = world_.simulation();
  simulation.on_action("call", [&](std::uint32_t robot, double value) {
    if (value > 0.0) simulation.act(SetPose{"box", at(-2, robot, 0.1)});
  });
  step_with(1.0, 1, "call");
  EXPECT_EQ(simulation.object_pose(box_).position, Eigen::Vector3d(-2, 1, 0.1));
}

class RunWithUserActions : public UserActions {
 protected:
  RunWithUserActions() {
    world_.world().instances[box_].is_present = false;
    close_gate_when_opened();
    react("call", {0}, gate_, description::SetPresence{true}, "enable");
    react("call", {1}, box_, description::SetPresence{true, true}, "add");
    react("open", {1}, box_, description::ApplyForce{0, {20, 0, 0}, {0, 0, 1}, 70ms}, "apply_force");
  }
  // Each robot does each of its actions now and then.
  static void command(Simulation& simulation) {
    const auto tick = static_cast<double>(simulation.tick());
    for (std::uint32_t robot = 0; robot < 2; ++robot)
      simulation.set_command(robot, std::vector<double>{0.1, 0.1, 0.0, std::abs(std::sin(0.3 * tick + robot)),
                                                        std::abs(std::cos(0.21 * tick + 2 * robot))});
  }
};

TEST_F(RunWithUserActions, GivesTheSameBitsOnAnyThreads) {
  world_.simulation();
  Simulation one(world_.experiment, 1);
  Simulation four(world_.experiment, 4);
  std::size_t happened = 0;
  for (int i = 0; i < 80; ++i) {
    for (Simulation* each : {&one, &four}) {
      command(*each);
      each->step();
    }
    ASSERT_EQ(one.state_hash(), four.state_hash()) << "tick " << one.tick();
    EXPECT_EQ(one.happened(), four.happened());
    happened += one.happened().size();
  }
  EXPECT_GT(happened, 10u);
}

TEST_F(RunWithUserActions, GoesOnFromASnapshotOfAnyTick) {
  world_.simulation();
  Simulation straight(world_.experiment, 1);
  for (int saved = 0; saved < 60; saved += 3) {
    Simulation restored(world_.experiment, 1);
    restored.restore(straight.save());
    ASSERT_EQ(restored.state_hash(), straight.state_hash()) << "tick " << saved;
    EXPECT_EQ(restored.save(), straight.save());
    for (int i = 0; i < 3; ++i)
      for (Simulation* each : {&straight, &restored}) {
        command(*each);
        each->step();
      }
    ASSERT_EQ(restored.state_hash(), straight.state_hash()) << "saved at tick " << saved;
    EXPECT_EQ(restored.happened(), straight.happened());
  }
}

TEST_F(RunWithUserActions, IsAnotherStateWhileAnActionIsDone) {
  Simulation& simulation = world_.simulation();
  const auto hash_after = [&](double value) {
    Simulation other(world_.experiment, 1);
    std::vector<double> command{0.0, 0.0, 0.0, 0.0, value};
    other.set_command(0, command);
    other.step();
    other.set_command(0, std::vector<double>(5, 0.0));  // the commands are the same again
    return other.state_hash();
  };
  EXPECT_NE(hash_after(0.0), hash_after(1.0));
  EXPECT_EQ(simulation.tick(), 0u);
}

// ---- Events for emitters ----

using description::EmitterChange;
using description::SetEmitters;

template <class Value>
EmitterChange changed(std::optional<Value> EmitterChange::*what, Value value) {
  EmitterChange change;
  change.*what = value;
  return change;
}

class EventsForEmitters : public ::testing::Test {
 protected:
  EventsForEmitters() {
    description::Model robot = tracked_robot();
    robot.devices.push_back(description::LightSensors{"light", 1, {{0, 0, 0.045}}, 8, 0.0, 0.785, 0.5, {}});
    robot.devices.push_back(
        description::Microphones{"microphones", 1, {{0, 0, 0.045}}, {{200, 400}, {400, 800}}, 2.0, {}});
    robot.devices.push_back(description::ClimateSensor{"climate", 1, {0, 0, 0.045}, {}});
    world_.add(robot, "robot", at(0, 0, 0));
    description::Model stand = static_shape("stand", description::Box{{0.1, 0.1, 0.01}});
    stand.emitters.push_back({"lamp", 0, {}, true, description::Light{}});
    stand.emitters.push_back({"siren", 0, {}, true, description::Sound{300.0, 0.5}});
    stand.emitters.push_back({"spot", 0, {}, true, description::Marker{{1, 0, 0}}});
    stand.emitters.push_back({"oven", 0, {}, true, description::ClimateSource{20.0, 0.1, 1.0}});
    stand_ = world_.add(stand, "stand", at(1, 0, 0.1));
  }
  void at_time(std::chrono::nanoseconds time, std::vector<std::size_t> emitters, EmitterChange change) {
    world_.experiment.events.push_back(
        {time, stand_, SetEmitters{std::move(emitters), std::move(change)}, "set_emitter"});
  }
  double light() { return world_.read(0, "light/0/reading"); }
  double sound(std::size_t band) { return world_.read(0, "microphones/0/intensity", band); }

  SensingWorld world_;
  std::uint32_t stand_ = 0;
};

TEST_F(EventsForEmitters, SwitchThemOffAndOnAtTheBoundaryBeforeTheRobotsSense) {
  at_time(20ms, {0, 1, 2, 3}, changed(&EmitterChange::is_on, false));
  at_time(40ms, {1}, changed(&EmitterChange::is_on, true));
  const double ambient = world_.world().climate.temperature;
  EXPECT_GT(light(), 0.2);
  EXPECT_GT(world_.read(0, "climate/0/temperature"), ambient + 5.0);
  world_.step(2);
  EXPECT_EQ(light(), 0.0);
  EXPECT_EQ(sound(0), 0.0);
  EXPECT_EQ(world_.read(0, "climate/0/temperature"), ambient);
  EXPECT_FALSE(world_.simulation().emitters().marker(0).is_on);
  EXPECT_EQ(world_.simulation().happened(), Sentences{"set_emitter 'stand'"});
  world_.step(2);
  EXPECT_GT(sound(0), 0.1);
  EXPECT_EQ(light(), 0.0);
}

TEST_F(EventsForEmitters, ChangeWhatIsOfTheirKindAndLeaveTheRest) {
  at_time(10ms, {0, 1, 2, 3}, {{}, 2.0, 500.0, Eigen::Vector3d(0, 0.3, 0), 5.0, 0.2});
  const double temperature = world_.read(0, "climate/0/temperature");
  world_.step();
  EXPECT_NEAR(light(), sigmoid(0.5 * 2.0 * 0.1), 1e-6) << "a tenth of white on the mean";
  EXPECT_EQ(sound(0), 0.0);
  EXPECT_NEAR(sound(1), sigmoid(2.0 * 2.0), 1e-3);
  EXPECT_EQ(world_.simulation().emitters().marker(0).color, Eigen::Vector3d(0, 0.3, 0));
  const double ambient = world_.world().climate.temperature;
  EXPECT_NEAR(world_.read(0, "climate/0/temperature") - ambient, 0.25 * (temperature - ambient), 1e-9);
}

TEST_F(EventsForEmitters, ArePartOfHashAndSnapshot) {
  at_time(20ms, {0}, changed(&EmitterChange::intensity, 2.0));
  at_time(30ms, {1}, changed(&EmitterChange::is_on, false));
  at_time(40ms, {3}, changed(&EmitterChange::temperature, 1.0));
  world_.simulation();
  Simulation straight(world_.experiment, 1);
  for (int tick = 0; tick < 6; ++tick) {
    Simulation restored(world_.experiment, 4);
    restored.restore(straight.save());
    ASSERT_EQ(restored.state_hash(), straight.state_hash()) << "tick " << tick;
    EXPECT_EQ(restored.save(), straight.save());
    straight.step();
    restored.step();
    ASSERT_EQ(restored.state_hash(), straight.state_hash()) << "saved at tick " << tick;
  }
  // Intensity, temperature and humidity count although no sensor reads them now.
  const std::uint64_t before = Simulation(world_.experiment, 1).state_hash();
  for (const EmitterChange& change :
       {changed(&EmitterChange::intensity, 3.0), changed(&EmitterChange::temperature, 3.0),
        changed(&EmitterChange::humidity, 0.3)}) {
    description::Experiment changed_at_first = world_.experiment;
    const std::size_t emitter = change.intensity ? 0 : 3;
    changed_at_first.events = {{0ms, stand_, description::SetEmitters{{emitter}, change}, "set_emitter"}};
    EXPECT_NE(Simulation(changed_at_first, 1).state_hash(), before);
  }
}

}  // namespace
}  // namespace cohort
