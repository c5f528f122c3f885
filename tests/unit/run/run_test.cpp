// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "server/run/exchange.hpp"
#include "server/run/in_process.hpp"
#include "server/run/model_tree.hpp"
#include "server/run/roster.hpp"
#include "server/run/run_events.hpp"
#include "server/run/run_monitor.hpp"
#include "tests/support/robots.hpp"

namespace cohort::session {
namespace {

using namespace test;
using Robots = std::vector<std::uint32_t>;

constexpr std::size_t observation_size = 21;
constexpr std::size_t left_position = 2;
const std::vector<double> forward = {0.2, 0.2, 0.0};

// Robots in a row, one team for each policy.
description::Experiment experiment_of(const std::vector<description::Policy>& policies) {
  description::Experiment experiment;
  experiment.world = world_with_floor();
  experiment.duration = std::chrono::milliseconds(100);
  for (std::uint32_t robot = 0; robot < policies.size(); ++robot) {
    place(experiment.world, tracked_robot(), "robot_" + std::to_string(robot), at(0.0, robot, 0.0));
    experiment.teams.push_back({"team_" + std::to_string(robot), {robot}, "none", policies[robot]});
  }
  return experiment;
}

TEST(Exchange, ACommandActsInTheStepThatFollowsItsFrame) {
  const auto experiment = experiment_of({{}});
  Simulation simulation(experiment, 1);
  Exchange exchange(simulation);
  exchange.open({});
  EXPECT_EQ(exchange.take(Robots{0}, 0, Robots{0}, forward).accepted, 1u);
  ASSERT_TRUE(exchange.barrier().complete());
  exchange.apply();
  simulation.step();
  EXPECT_GT(simulation.observation(0)[left_position], 0.0) << "it moves within [0, 1)";
}

TEST(Exchange, AnAnswerActsExactlyItsDelayLaterAndNeutralValuesUntilThen) {
  const auto experiment = experiment_of({{1, 0, 3, description::OnLate::wait, {}}});
  Simulation simulation(experiment, 1);
  Exchange exchange(simulation);
  std::vector<std::uint64_t> moving_from;
  for (std::uint64_t tick = 0; tick < 5; ++tick) {
    exchange.open({});
    exchange.take(Robots{0}, tick, Robots{0}, forward);
    ASSERT_TRUE(exchange.barrier().complete());
    exchange.apply();
    const double before = simulation.observation(0)[left_position];
    simulation.step();
    if (simulation.observation(0)[left_position] > before + 1e-6) moving_from.push_back(tick);
  }
  EXPECT_EQ(moving_from, (std::vector<std::uint64_t>{3, 4}));
}

TEST(Exchange, FramesHoldTheRobotsThatAreDueAndTheirObservationsAsTheyWere) {
  const auto experiment =
      experiment_of({{1, 0, 2, description::OnLate::wait, {}}, {2, 1, 0, description::OnLate::wait, {}}});
  Simulation simulation(experiment, 1);
  Exchange exchange(simulation);
  Exchange::Frame frame;
  exchange.open({});
  exchange.fill_frame(frame, Robots{0, 1}, 0);
  EXPECT_EQ(frame.robots, Robots{0});
  const std::vector<double> first(frame.values.begin(), frame.values.end());
  EXPECT_EQ(first.size(), observation_size);
  exchange.take(Robots{0}, 0, Robots{0}, forward);
  exchange.apply();
  simulation.set_command(0, forward);
  simulation.step();

  exchange.open({});
  exchange.fill_frame(frame, Robots{0, 1}, 1);
  EXPECT_EQ(frame.robots, (Robots{0, 1}));
  EXPECT_EQ(frame.values.size(), 2 * observation_size);
  exchange.fill_frame(frame, Robots{0, 1}, 0);
  EXPECT_TRUE(std::ranges::equal(frame.values, first)) << "the frame under way is sent again as it was";
}

TEST(Exchange, RejectsAnAnswerForOtherRobotsThanItsFrame) {
  const auto experiment = experiment_of({{}, {}});
  Simulation simulation(experiment, 1);
  Exchange exchange(simulation);
  exchange.open({});
  const auto taken = exchange.take(Robots{0, 1}, 0, Robots{0}, forward);
  EXPECT_EQ(taken.accepted, 0u);
  EXPECT_EQ(taken.rejection->reason, "malformed");
  EXPECT_FALSE(taken.is_fault);
  EXPECT_EQ(exchange.barrier().awaited().size(), 2u) << "they can still answer rightly";
}

// Answers that were sent again arrive late, when the robots of their frames are no longer known.
TEST(Exchange, LateAnswersOfRobotsThatHaveGoneAreStale) {
  const auto experiment = experiment_of({{}, {}});
  Simulation simulation(experiment, 1);
  Exchange exchange(simulation);
  const std::vector<double> both = {0.2, 0.2, 0.0, 0.2, 0.2, 0.0};
  const auto pass = [&](const Robots& robots, std::span<const double> values) {
    exchange.open({});
    const std::uint64_t tick = simulation.tick();
    EXPECT_EQ(exchange.take(Robots{0, 1}, tick, robots, values).accepted, robots.size());
    exchange.apply();
    simulation.step();
  };
  pass({0, 1}, both);
  simulation.act(std::vector<Action>{RemoveObject{"robot_1"}});
  pass({0}, forward);
  exchange.open({});
  for (const std::uint64_t tick : {0, 1}) {
    const Robots robots = tick == 0 ? Robots{0, 1} : Robots{0};
    const auto late = exchange.take(Robots{0, 1}, tick, robots, tick == 0 ? std::span(both) : std::span(forward));
    ASSERT_TRUE(late.rejection);
    EXPECT_EQ(late.rejection->reason, "stale") << tick;
  }
  EXPECT_EQ(exchange.take(Robots{0, 1}, 2, Robots{0, 1}, both).rejection->reason, "malformed");
  EXPECT_EQ(exchange.take(Robots{0, 1}, 2, Robots{0}, forward).accepted, 1U);
}

TEST(Exchange, AFreeRobotAnswersOlderFramesAfterAnotherHasGone) {
  const description::Policy free{.mode = description::Mode::free};
  const auto experiment = experiment_of({free, free});
  Simulation simulation(experiment, 1);
  Exchange exchange(simulation);
  exchange.open({});
  simulation.step();
  simulation.act(std::vector<Action>{RemoveObject{"robot_1"}});
  for (int i = 0; i < 3; ++i) {
    exchange.open({});
    exchange.apply();
    simulation.step();
  }
  const auto taken = exchange.take(Robots{0, 1}, 2, Robots{0}, forward);
  EXPECT_EQ(taken.accepted, 1U);
  EXPECT_FALSE(taken.rejection);
}

TEST(Exchange, ReadsNothingBeyondAnAnswerThatIsTooShort) {
  const auto experiment = experiment_of({{}, {}});
  Simulation simulation(experiment, 1);
  Exchange exchange(simulation);
  exchange.open({});
  const auto taken = exchange.take(Robots{0, 1}, 0, Robots{0, 1}, std::vector<double>{0.1, 0.1});
  EXPECT_EQ(taken.rejection->reason, "wrong_size");
  EXPECT_TRUE(taken.is_fault);
  EXPECT_TRUE(taken.ends_run);
}

TEST(Exchange, AFaultyAnswerUnderZeroGivesNeutralValuesAndTheRunGoesOn) {
  const auto experiment = experiment_of({{1, 0, 0, description::OnLate::zero, std::chrono::seconds(1)}});
  Simulation simulation(experiment, 1);
  simulation.set_command(0, forward);
  Exchange exchange(simulation);
  exchange.open({});
  const auto taken = exchange.take(Robots{0}, 0, Robots{0}, std::vector<double>{9.0, 0.0, 0.0});
  EXPECT_EQ(taken.rejection->reason, "out_of_range");
  EXPECT_FALSE(taken.ends_run);
  ASSERT_TRUE(exchange.barrier().complete());
  exchange.apply();
  simulation.step();
  EXPECT_LT(std::abs(simulation.observation(0)[left_position]), 1e-4) << "at 0.2 m/s it would be 2 mm";
}

TEST(RunMonitor, IsDueAtAnySpeedHoweverSmall) {
  const auto experiment = experiment_of({{}});
  Simulation simulation(experiment, 1);
  RunMonitor monitor(experiment, simulation, {.speed = 1e-300}, {});
  monitor.start();
  EXPECT_LE(*monitor.due_time(), RunMonitor::Clock::now());
  simulation.step();
  EXPECT_GT(*monitor.due_time(), RunMonitor::Clock::now() + std::chrono::hours(1000));
  monitor.set_speed(1e300);
  simulation.step();
  EXPECT_LE(*monitor.due_time(), RunMonitor::Clock::now());
}

TEST(RunMonitor, CountsTicksThatBeginLaterThanAStepTakesAtTheAskedSpeed) {
  const auto experiment = experiment_of({{}});
  Simulation simulation(experiment, 1);
  RunMonitor monitor(experiment, simulation, {.speed = 2.0}, {});
  monitor.start();
  const auto step_at_this_speed = experiment.world.step / 2;
  monitor.add_lateness(step_at_this_speed - std::chrono::microseconds(1));
  monitor.add_lateness(step_at_this_speed + std::chrono::microseconds(1));
  const RunResult result = monitor.finish(RunResult::End::finished);
  EXPECT_EQ(result.late_ticks, 1u);
  EXPECT_EQ(result.lateness.count(), 2u);
}

TEST(Roster, ADescriptionsNumberIsMadeFromItsContents) {
  const auto experiment = experiment_of({{}});
  wire::RobotDescription kind = describe_kinds(Simulation(experiment, 1)).front();
  const std::uint32_t number = number_of(kind);
  kind.description = 7;
  EXPECT_EQ(number_of(kind), number) << "whichever server says it";
  const auto expect_another = [&](const auto& change) {
    wire::RobotDescription other = kind;
    change(other);
    EXPECT_NE(number_of(other), number);
  };
  expect_another([](auto& other) { other.model += "2"; });
  expect_another([](auto& other) { std::swap(other.observation, other.command); });
  expect_another([](auto& other) { other.command.back().upper += 1e-9; });
  expect_another([](auto& other) { other.command.front().unit = "N"; });
  expect_another([](auto& other) { other.observation.pop_back(); });
  expect_another([](auto& other) { other.tree.links.back().mass += 1e-9; });
  expect_another([](auto& other) { other.tree.joints.back().axes.back().upper = 1e9; });
  expect_another([](auto& other) { other.tree.joints.back().devices.pop_back(); });
  expect_another([](auto& other) { other.tree.sensors.back().pose.position.z += 1e-9; });
}

TEST(Roster, ATreeHasTheLinksJointsAndSensorsOfTheModel) {
  description::Model model = tracked_robot();
  model.joints[0].axis.lower = -2.0;
  model.joints[0].axis.upper = 3.0;
  model.joints[0].axis.max_velocity = 1.5;
  model.joints[0].axis.max_effort = 0.3;
  model.joints[0].X_LJ.position = {0.0, 0.01, 0.0};
  const KinematicTree tree = tree_of(model);
  ASSERT_EQ(tree.links.size(), 2u);
  EXPECT_EQ(tree.links[1], (LinkInfo{"turret", 0.3, {0, 0, 0.02}}));
  const JointInfo turret_joint{.name = "turret_joint",
                               .type = JointInfo::Type::revolute,
                               .parent = 0,
                               .child = 1,
                               .pose = {{0, 0, figures::turret_height}, {}},
                               .frame = {{0, 0.01, 0}, {}},
                               .axes = {{{0, 0, 1}, -2.0, 3.0, 1.5, 0.3}},
                               .devices = {"turret", "turret"}};  // a motor and an encoder
  EXPECT_EQ(tree.joints, std::vector{turret_joint});
  EXPECT_EQ(tree.sensors, (std::vector<SensorInfo>{{"proximity", 1, {{0, 0, 0.02}, {}}}}));
}

TEST(Roster, ATreeHasTheAxesThatEachJointMoves) {
  const auto axes_of = [](description::JointType type) {
    description::Model model = tracked_robot();
    model.devices.clear();
    model.joints[0].type = type;
    model.joints[0].second_axis.direction = {0, 1, 0};
    return tree_of(model).joints[0].axes;
  };
  EXPECT_TRUE(axes_of(description::JointType::ball).empty());
  EXPECT_EQ(axes_of(description::JointType::screw).size(), 1u);
  const auto both = axes_of(description::JointType::universal);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[1].direction, (Vector3{0, 1, 0}));
}

TEST(Roster, ATreeIsRelativeToTheRootLinkAndHasTheWorldAsAParent) {
  description::Model model = tracked_robot();
  const Pose raised{{0, 0, 1}, Eigen::Quaterniond::Identity()};
  for (description::Link& link : model.links) link.X_ML = raised * link.X_ML;
  EXPECT_NEAR(tree_of(model).joints[0].pose.position.z, figures::turret_height, 1e-12);
  description::Joint mount;
  mount.name = "mount";
  mount.parent = description::Joint::world;
  model.joints.insert(model.joints.begin(), mount);
  const JointInfo joint = tree_of(model).joints[0];
  EXPECT_EQ(joint.parent, JointInfo::world);
  EXPECT_EQ(joint.pose.position, (Vector3{0, 0, 1}));
}

class TreeReader final : public Controller {
 public:
  static inline KinematicTree read;
  void start(const Start& start) override { read = start.tree; }
  void step(const Observation&, Command&) override {}
};

TEST(InProcessRun, GivesControllersTheTreeOfTheirRobot) {
  const auto experiment = experiment_of({{}});
  Simulation simulation(experiment, 1);
  const std::atomic<bool> stop = false;
  const ControllerKind kind = {"TreeReader",
                               [] { return OwnedController(new TreeReader, [](Controller* it) { delete it; }); }};
  run_in_process(experiment, simulation, {kind}, {}, {}, stop);
  EXPECT_EQ(TreeReader::read, tree_of(experiment.world.models[experiment.world.instances.back().model]));
  EXPECT_FALSE(TreeReader::read.joints.empty());
}

TEST(Roster, SeedsOfControllersDependOnTheExperimentsSeedAndTheRobotsNameOnly) {
  auto experiment = experiment_of({{}, {}});
  const Simulation two(experiment, 1);
  const auto admitted = [](const auto& of, const Simulation& simulation, const Robots& robots) {
    wire::Admit admit;
    admit_robots(admit, of, simulation, robots);
    return admit.robots;
  };
  const auto first = admitted(experiment, two, {0, 1});
  EXPECT_NE(first[0].seed, first[1].seed);
  const auto alone = experiment_of({{}});
  const Simulation one(alone, 1);
  EXPECT_EQ(admitted(alone, one, {0})[0].seed, first[0].seed);
  experiment.seed = 99;
  EXPECT_NE(admitted(experiment, two, {0})[0].seed, first[0].seed);
}

TEST(EventLog, CountsWhatIsTheSameAndIsBounded) {
  EventLog log;
  EXPECT_TRUE(log.add(3, "rejected", "stale"));
  EXPECT_FALSE(log.add(9, "rejected", "stale", 4));
  ASSERT_EQ(log.events().size(), 1u);
  EXPECT_EQ(log.events()[0].tick, 3u);
  EXPECT_EQ(log.events()[0].count, 5u);
  for (int i = 0; i < 5000; ++i) log.add(10, "rejected", std::to_string(i));
  EXPECT_EQ(log.events().size(), 1001u);
  EXPECT_EQ(log.events().back().kind, "more");
  EXPECT_EQ(log.events().back().count, 5001u - 1000u);
  EXPECT_TRUE(log.add(11, "joined", "somebody")) << "others have their own room";
}

TEST(EventLog, TellsWhatHasChangedSince) {
  EventLog log;
  log.add(1, "joined", "a");
  log.add(2, "missed", "b");
  std::uint64_t revision = 0;
  EXPECT_EQ(log.changed_since(revision, 10).size(), 2u);
  EXPECT_EQ(revision, log.revision());
  EXPECT_TRUE(log.changed_since(revision, 10).empty());
  log.add(7, "joined", "c");
  log.add(8, "joined", "a");
  const std::vector<RunEvent> first = log.changed_since(revision, 1);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].text, "c");
  const std::vector<RunEvent> second = log.changed_since(revision, 1);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(second[0].text, "a");
  EXPECT_EQ(second[0].tick, 1u);
  EXPECT_EQ(second[0].last_tick, 8u);
  EXPECT_EQ(second[0].count, 2u);
  EXPECT_EQ(revision, log.revision());
}

class Straight final : public Controller {
 public:
  void start(const Start& start) override {
    left_ = start.command("treel/left/velocity");
    right_ = start.command("treel/right/velocity");
  }
  void step(const Observation& observation, Command& command) override {
    if (observation.tick() == 5) throw std::runtime_error("I have had enough");
    command.set(left_, 0.1);
    command.set(right_, 0.1);
  }

 private:
  CommandChannel left_, right_;
};

const Plugin straight = {Plugin::current_abi, "Straight", []() -> Controller* { return new Straight; },
                         [](Controller* controller) { delete controller; }};

TEST(InProcessRun, EndsWithTheMessageOfAControllerThatThrows) {
  const auto experiment = experiment_of({{}});
  Simulation simulation(experiment, 1);
  const std::atomic<bool> stop = false;
  const RunResult result = run_in_process(experiment, simulation, {kind_of(straight)}, {}, {}, stop);
  EXPECT_EQ(result.end, RunResult::End::failed);
  EXPECT_EQ(result.ticks, 5u);
  EXPECT_NE(result.error.find("robot_0"), std::string::npos) << result.error;
  EXPECT_NE(result.error.find("I have had enough"), std::string::npos) << result.error;
}

class Unsaved final : public Controller {
 public:
  void start(const Start&) override {}
  void step(const Observation&, Command&) override {}
  void save(StateWriter&) const override { throw std::runtime_error("it cannot be told"); }
};

TEST(InProcessRun, GoesOnWhenAControllerCannotSave) {
  const auto experiment = experiment_of({{}});
  Simulation simulation(experiment, 1);
  const std::atomic<bool> stop = false;
  RunListener listener;
  listener.can_save = [](const auto& take) { take(); };
  const ControllerKind kind = {"Unsaved",
                               [] { return OwnedController(new Unsaved, [](Controller* it) { delete it; }); }};
  const RunResult result = run_in_process(experiment, simulation, {kind}, {}, listener, stop);
  EXPECT_EQ(result.end, RunResult::End::finished) << result.error;
  EXPECT_EQ(result.ticks, 10u);
  ASSERT_EQ(result.events.size(), 1u);
  EXPECT_EQ(result.events[0].kind, "unsaved");
  for (const char* said : {"team_0", "robot_0", "it cannot be told"})
    EXPECT_NE(result.events[0].text.find(said), std::string::npos) << result.events[0].text;
}

TEST(InProcessRun, StopsWhenAskedTo) {
  const auto experiment = experiment_of({{}});
  Simulation simulation(experiment, 1);
  const std::atomic<bool> stop = true;
  const RunResult result = run_in_process(experiment, simulation, {kind_of(straight)}, {}, {}, stop);
  EXPECT_EQ(result.end, RunResult::End::interrupted);
  EXPECT_EQ(result.ticks, 0u);
}

TEST(InProcessRun, ShowsTheLastBoundaryAlsoWhenItIsStopped) {
  const auto experiment = experiment_of({{}});
  Simulation simulation(experiment, 1);
  std::atomic<bool> stop = false;
  std::vector<std::uint64_t> boundaries;
  RunListener listener;
  listener.boundary = [&] {
    boundaries.push_back(simulation.tick());
    stop = simulation.tick() >= 2;
  };
  const RunResult result = run_in_process(experiment, simulation, {kind_of(straight)}, {}, listener, stop);
  EXPECT_EQ(result.end, RunResult::End::interrupted);
  EXPECT_EQ(result.ticks, 3u);
  EXPECT_EQ(boundaries, (std::vector<std::uint64_t>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace cohort::session
