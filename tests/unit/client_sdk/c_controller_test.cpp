// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/include/cohort/cohort.h"
#include "client_sdk/include/cohort/cohort_tree.h"
#include "tests/support/counting_controller.hpp"

namespace cohort {
namespace {

using namespace test;

// The callbacks of the controller under test call these, since C has no closures.
struct Script {
  std::function<int(const CohortStart*)> start = [](const CohortStart*) { return 0; };
  std::function<int(const CohortObservation*, CohortCommand*)> step = [](const CohortObservation*, CohortCommand*) {
    return 0;
  };
  bool can_create = true;
  int created = 0;
  int destroyed = 0;
};

Script& script() {
  static Script its_script;
  return its_script;
}

const CohortController scripted = {"scripted",
                                   []() -> void* { return script().can_create ? &++script().created : nullptr; },
                                   [](void*, const CohortStart* start) { return script().start(start); },
                                   [](void*, const CohortObservation* observation, CohortCommand* command) {
                                     return script().step(observation, command);
                                   },
                                   [](void*) { ++script().destroyed; }};

Plugin scripted_plugin() {
  return {Plugin::current_abi, "scripted",
          []() -> Controller* { return static_cast<Controller*>(cohort_make_controller(&scripted)); },
          [](Controller* controller) { cohort_destroy_controller(controller); }};
}

class CControllerTest : public testing::Test {
 protected:
  CControllerTest() { script() = Script(); }

  void start(wire::StartReason reason = wire::StartReason::first) {
    wire::Admit admit{.start_reason = reason, .tick = 100, .step_ns = 10'000'000};
    admit.robots = {{.robot = 3, .name = "r3", .seed = 77, .period = 2}};
    admit.teams = {{.name = "counters", .controller = "scripted", .parameters = parameters}};
    host.start(admit, descriptions);
  }
  std::string failure_of_start() {
    try {
      start();
    } catch (const ControllerFailure& failure) {
      return failure.what();
    }
    return "it did not fail";
  }
  std::vector<double> answer(double reading) {
    const std::vector<std::uint32_t> robots{3};
    const std::vector<double> values{reading};
    const auto answered = host.answer({.tick = 100, .time_ns = 1'000'000'000, .robots = robots, .values = values});
    return {answered.begin(), answered.end()};
  }

  std::vector<wire::RobotDescription> descriptions{CountingController::description()};
  std::vector<wire::Parameter> parameters;
  ControllerHost host{scripted_plugin()};
};

void expect_in(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in '" << text << "'";
}

TEST_F(CControllerTest, GetsTheSameStartAsAControllerInCpp) {
  script().start = [](const CohortStart* start) {
    const CohortStartInfo* info = cohort_start_info(start);
    EXPECT_EQ(info->robot, 3u);
    EXPECT_STREQ(info->name, "r3");
    EXPECT_STREQ(info->model, "counter");
    EXPECT_STREQ(info->team, "counters");
    EXPECT_STREQ(info->controller, "scripted");
    EXPECT_EQ(info->reason, cohort_start_takeover);
    EXPECT_EQ(info->tick, 100u);
    EXPECT_EQ(info->seed, 77u);
    EXPECT_EQ(info->step_ns, 10'000'000);
    EXPECT_EQ(info->period, 2u);
    return 0;
  };
  start(wire::StartReason::takeover);
}

TEST_F(CControllerTest, GetsTheLinksJointsAndSensorsOfItsRobot) {
  const FramePose pose{{1, 2, 3}, {0.5, 0.5, 0.5, -0.5}};
  descriptions[0].tree = {.links = {{"hull", 0.4, {4, 5, 6}}, {}},
                          .joints = {{.name = "wheel",
                                      .type = JointInfo::Type::screw,
                                      .parent = JointInfo::world,
                                      .child = 1,
                                      .pose = pose,
                                      .frame = {},
                                      .axes = {{{0, 1, 0}, -1.0, 2.0, 3.0, 4.0}},
                                      .thread_pitch = 0.5,
                                      .devices = {"encoder"}}},
                          .sensors = {{"lidar", 1, pose}}};
  script().start = [](const CohortStart* start) {
    CohortLink link{};
    EXPECT_TRUE(cohort_link(start, 0, &link));
    EXPECT_STREQ(link.name, "hull");
    EXPECT_EQ(link.mass, 0.4);
    EXPECT_EQ(link.center_of_mass[2], 6.0);
    EXPECT_FALSE(cohort_link(start, 2, &link));
    CohortJoint joint{};
    EXPECT_TRUE(cohort_joint(start, 0, &joint));
    EXPECT_STREQ(joint.name, "wheel");
    EXPECT_EQ(joint.type, cohort_joint_screw);
    EXPECT_EQ(joint.parent, COHORT_WORLD);
    EXPECT_EQ(joint.child, 1u);
    EXPECT_EQ(joint.pose.position[1], 2.0);
    EXPECT_EQ(joint.pose.orientation[3], -0.5);
    EXPECT_EQ(joint.frame.orientation[3], 1.0);
    EXPECT_EQ(joint.axis_count, 1u);
    EXPECT_EQ(joint.axes[0].direction[1], 1.0);
    EXPECT_EQ(joint.axes[0].lower, -1.0);
    EXPECT_EQ(joint.axes[0].max_effort, 4.0);
    EXPECT_EQ(joint.thread_pitch, 0.5);
    EXPECT_STREQ(cohort_joint_device(start, 0, 0), "encoder");
    EXPECT_EQ(cohort_joint_device(start, 0, 1), nullptr);
    EXPECT_EQ(cohort_joint_device(start, 1, 0), nullptr);
    CohortSensor sensor{};
    EXPECT_TRUE(cohort_sensor(start, 0, &sensor));
    EXPECT_STREQ(sensor.name, "lidar");
    EXPECT_EQ(sensor.pose.position[2], 3.0);
    EXPECT_FALSE(cohort_sensor(start, 1, &sensor));
    return 0;
  };
  start();
}

TEST_F(CControllerTest, ReadsAndSetsTheChannelsThatItFinds) {
  CohortObservationChannel reading{};
  CohortCommandChannel doubled{};
  CohortCommandChannel unused{};
  double read_all = 0.0;
  script().start = [&](const CohortStart* start) {
    EXPECT_TRUE(cohort_has_observation(start, "sensor/0/reading"));
    EXPECT_FALSE(cohort_has_command(start, "sensor/0/reading"));
    CohortCommandChannel two[2] = {};
    EXPECT_EQ(cohort_find_commands(start, "count/0/*", two, 2), 5u);
    EXPECT_EQ(two[1].offset, 1u);
    EXPECT_EQ(cohort_find_observations(start, "sensor/*/reading", &reading, 1), 1u);
    doubled = cohort_find_command(start, "count/0/doubled");
    unused = cohort_find_command(start, "count/0/unused");
    return 0;
  };
  script().step = [&](const CohortObservation* observation, CohortCommand* command) {
    EXPECT_EQ(cohort_tick(observation), 100u);
    EXPECT_EQ(cohort_time_ns(observation), 1'000'000'000);
    read_all = cohort_read_all(observation, reading)[0];
    cohort_set(command, doubled, 2.0 * cohort_read(observation, reading));
    cohort_set_at(command, unused, 1, -5.0);
    return 0;
  };
  start();
  EXPECT_EQ(unused.size, 2u);
  EXPECT_EQ(answer(0.5), (std::vector<double>{0, 0, 1.0, 0, 0.25, -1.0})) << "neutral but for what it set, in range";
  EXPECT_EQ(read_all, 0.5);
  EXPECT_TRUE(std::isnan(answer(std::numeric_limits<double>::quiet_NaN())[2])) << "passed on";
}

TEST_F(CControllerTest, AMissingChannelFailsTheStartEvenIfTheCallbackSucceeds) {
  script().start = [](const CohortStart* start) {
    EXPECT_EQ(cohort_find_observation(start, "sensr/0/reading").size, 0u);
    EXPECT_NE(std::string(cohort_last_error()).find("nearest"), std::string::npos);
    EXPECT_EQ(cohort_find_command(start, "a second mistake").size, 0u);
    return 0;
  };
  const std::string failure = failure_of_start();
  expect_in("robot 'r3' failed in start at tick 100", failure);
  expect_in("has no observation channel 'sensr/0/reading'; the nearest are sensor/0/reading", failure);
  for (const auto& wrong :
       {+[](const CohortStart* start) { return cohort_find_commands(start, "x/*", nullptr, 0); },
        +[](const CohortStart* start) { return cohort_find_observations(start, "x/*", nullptr, 0); }}) {
    script().start = [&](const CohortStart* start) { return static_cast<int>(wrong(start)); };
    expect_in("'x/*'; the nearest are", failure_of_start());
  }
}

TEST_F(CControllerTest, ReadsParametersOfEveryKind) {
  parameters = {
      {"gain", {"0.5"}}, {"count", {"-3"}}, {"loud", {"true"}}, {"mode", {"slow"}}, {"weights", {"1", "2", "3"}},
      {"path", {"/a"}}};
  script().start = [](const CohortStart* start) {
    EXPECT_EQ(cohort_needed_real(start, "gain"), 0.5);
    EXPECT_EQ(cohort_real(start, "gain", 1.0), 0.5);
    EXPECT_EQ(cohort_real(start, "other", 1.0), 1.0);
    EXPECT_EQ(cohort_whole(start, "count", 7), -3);
    EXPECT_EQ(cohort_whole(start, "other", 7), 7);
    EXPECT_TRUE(cohort_flag(start, "loud", false));
    EXPECT_TRUE(cohort_flag(start, "other", true));
    const char* const mode = cohort_text(start, "mode", "fast");
    EXPECT_STREQ(cohort_needed_text(start, "path"), "/a");
    EXPECT_STREQ(cohort_text(start, "other", "fast"), "fast");
    EXPECT_STREQ(mode, "slow") << "still there";
    double weights[2] = {};
    EXPECT_EQ(cohort_reals(start, "weights", weights, 2), 3u);
    EXPECT_EQ(weights[1], 2.0);
    EXPECT_EQ(cohort_reals(start, "other", weights, 2), 0u);
    EXPECT_TRUE(cohort_has_parameter(start, "mode"));
    EXPECT_FALSE(cohort_has_parameter(start, "other"));
    return 0;
  };
  EXPECT_EQ(failure_of_start(), "it did not fail");
}

TEST_F(CControllerTest, AnInvalidMissingOrUnreadParameterFailsTheStart) {
  const auto failure_with = [&](const std::string& value, const std::function<void(const CohortStart*)>& ask) {
    parameters = {{"a", {value}}};
    script().start = [&](const CohortStart* start) {
      ask(start);
      return 0;
    };
    return failure_of_start();
  };
  const auto ask_whole = [](const CohortStart* start) { EXPECT_EQ(cohort_whole(start, "a", 7), 7); };
  expect_in("parameter 'a': expected a number, not 'x'",
            failure_with("x", [](const CohortStart* start) { EXPECT_EQ(cohort_real(start, "a", 2.0), 2.0); }));
  expect_in("parameter 'a': expected a whole number, not '1.5'", failure_with("1.5", ask_whole));
  expect_in("expected a whole number", failure_with("1e300", ask_whole));
  expect_in("expected true or false",
            failure_with("1", [](const CohortStart* start) { cohort_flag(start, "a", true); }));
  expect_in("expected a number",
            failure_with("x", [](const CohortStart* start) { cohort_reals(start, "a", nullptr, 0); }));
  expect_in("parameter 'b': required by the controller", failure_with("1", [](const CohortStart* start) {
              cohort_real(start, "a", 0.0);
              EXPECT_STREQ(cohort_needed_text(start, "b"), "");
            }));
  expect_in("parameter 'b': required by the controller", failure_with("1", [](const CohortStart* start) {
              cohort_real(start, "a", 0.0);
              EXPECT_EQ(cohort_needed_real(start, "b"), 0.0);
            }));
  expect_in("parameter 'a': unknown parameter", failure_with("1", [](const CohortStart*) {}));
}

TEST_F(CControllerTest, ACallbackThatFailsEndsTheRunWithItsReason) {
  script().can_create = false;
  expect_in("create returned NULL", failure_of_start());
  script().can_create = true;
  script().start = [](const CohortStart*) { return cohort_fail("no %s of %d", "arm", 2); };
  expect_in("failed in start at tick 100: no arm of 2", failure_of_start());
  script().start = [](const CohortStart*) { return 7; };
  expect_in("the callback returned 7 without an error message", failure_of_start());

  script().start = [](const CohortStart*) { return 0; };
  script().step = [](const CohortObservation*, CohortCommand*) { return cohort_fail("it hurts"); };
  start();
  try {
    answer(0.0);
    ADD_FAILURE() << "it does not fail";
  } catch (const ControllerFailure& failure) {
    expect_in("robot 'r3' failed in step at tick 100: it hurts", failure.what());
  }
}

TEST_F(CControllerTest, IsCreatedOncePerRobotKeptAtAResetAndDestroyed) {
  { ControllerHost unused(scripted_plugin()); }
  EXPECT_EQ(script().created, 0);
  start();
  start(wire::StartReason::reset);
  EXPECT_EQ(script().created, 1);
  EXPECT_EQ(script().destroyed, 0);
  start(wire::StartReason::takeover);
  EXPECT_EQ(script().created, 2);
  EXPECT_EQ(script().destroyed, 1);
}

}  // namespace
}  // namespace cohort
