// SPDX-License-Identifier: Apache-2.0
#include "tools/view/driving/driver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/fake_server.hpp"
#include "tools/view/driving/drivers.hpp"

namespace cohort::view {
namespace {

using namespace std::chrono_literals;
using namespace test;
using Values = std::vector<double>;

// Two wheels, and two values that rest at 0.5.
const wire::RobotDescription description{.description = 0,
                                         .model = "cart",
                                         .observation = {{"odometer/0/way", "m", 1, -1e9, 1e9, 0.0}},
                                         .command = {{"wheels/left/velocity", "m/s", 1, -0.2, 0.2, 0.0},
                                                     {"wheels/right/velocity", "m/s", 1, -0.2, 0.2, 0.0},
                                                     {"arm/0/angles", "rad", 2, 0.0, 1.0, 0.5}}};
const Values neutral{0.0, 0.0, 0.5, 0.5};

std::vector<ChannelInfo> channels(std::uint32_t size) { return {{"arm/0/angles", "rad", 0, size, 0.0, 1.0, 0.5}}; }

std::string refusal_of(HeldCommand& command, const Values& values) {
  try {
    command.give(values, {});
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST(HeldCommand, WhatCameLastCountsForHalfASecond) {
  HeldCommand command;
  const HeldCommand::Clock::time_point now{1h};
  command.begin(channels(2));
  EXPECT_TRUE(command.values(now).empty()) << "nothing came yet";
  command.give({0.1, 0.2}, now);
  command.give({0.3, 0.4}, now + 100ms);
  EXPECT_EQ(command.values(now + 600ms), (Values{0.3, 0.4}));
  EXPECT_TRUE(command.values(now + 601ms).empty()) << "nobody may be there any more";
  EXPECT_EQ(command.silence(now + 700ms), 600ms);
  command.give({0.5, 0.6}, now + 10s);
  EXPECT_EQ(command.values(now + 10s), (Values{0.5, 0.6}));
}

TEST(HeldCommand, RefusesWhatIsNoCommandOfTheRobot) {
  HeldCommand command;
  command.begin(channels(2));
  EXPECT_EQ(refusal_of(command, {0.1}), "the robot's command has 2 values, not 1");
  EXPECT_EQ(refusal_of(command, {0.1, 0.2, 0.3}), "the robot's command has 2 values, not 3");
  EXPECT_EQ(refusal_of(command, {0.1, std::nan("")}), "expected finite numbers in a command");
  EXPECT_EQ(refusal_of(command, {std::numeric_limits<double>::infinity(), 0.0}),
            "expected finite numbers in a command");
  EXPECT_EQ(refusal_of(command, {}), "none");
}

TEST(HeldCommand, AResetKeepsItAndARobotOfAnotherKindDoesNot) {
  HeldCommand command;
  command.begin(channels(2));
  command.give({0.1, 0.2}, {});
  command.begin(channels(2));
  EXPECT_EQ(command.values({}), (Values{0.1, 0.2}));
  command.begin(channels(3));
  EXPECT_TRUE(command.values({}).empty());
}

TEST(ObedientController, CommandsWhatIsHeldWithinTheRangesAndLeavesParametersToOthers) {
  HeldCommand command;
  int begun = 0;
  ControllerHost host(obedient_controllers(command, [&] { ++begun; }));
  wire::Admit admit{.teams = {{"drivers", "keyboard", {{"up.wheels/left/velocity", {"0.1"}}}}},
                    .robots = {{.robot = 0, .name = "cart"}}};
  const auto start = [&] { host.start(admit, std::vector{description}); };
  const auto answer = [&] {
    const std::vector<std::uint32_t> robots{0};
    const Values observed{0.0};
    const auto values = host.answer({.robots = robots, .values = observed});
    return Values(values.begin(), values.end());
  };
  start();
  EXPECT_EQ(answer(), neutral);
  command.give({0.1, -7.0, 0.25, 7.0}, HeldCommand::Clock::now());
  EXPECT_EQ(answer(), (Values{0.1, -0.2, 0.25, 1.0}));
  admit.start_reason = wire::StartReason::reset;
  command.give({0.1, 0.1, 0.5, 0.5}, HeldCommand::Clock::now());
  start();
  EXPECT_EQ(answer(), (Values{0.1, 0.1, 0.5, 0.5}));
  EXPECT_EQ(begun, 2);
}

// Drivers that answer requests of pages, and a server whose replies the test chooses.
class DriversTest : public testing::Test {
 protected:
  struct ReceivedRequest {
    std::mutex mutex;
    std::optional<Answer> answer;
  };

  // The answer may come later: `answer_to` waits for it.
  std::shared_ptr<ReceivedRequest> ask(std::uint64_t page, Values numbers = {}, const std::string& name = "team/cart") {
    const auto asked = std::make_shared<ReceivedRequest>();
    drivers->drive({.operation = "drive", .name = name, .numbers = std::move(numbers), .visitor = page},
                   [asked](const Answer& answer) {
                     const std::lock_guard lock(asked->mutex);
                     EXPECT_FALSE(asked->answer) << "answered twice";
                     asked->answer = answer;
                   });
    return asked;
  }
  static Answer answer_to(const std::shared_ptr<ReceivedRequest>& asked) {
    const auto is_there = [&] {
      const std::lock_guard lock(asked->mutex);
      return asked->answer.has_value();
    };
    return eventually(is_there) ? *asked->answer : Answer{false, "no answer came"};
  }
  Answer drive(std::uint64_t page, Values numbers = {}, const std::string& name = "team/cart") {
    return answer_to(ask(page, std::move(numbers), name));
  }
  void admit(std::uint64_t epoch = 1, wire::StartReason reason = wire::StartReason::first) {
    server.describe(description);
    server.admit(
        {.epoch = epoch, .start_reason = reason, .step_ns = 10'000'000, .robots = {{.robot = 0, .name = "team/cart"}}});
  }
  // A page has the robot from now on.
  void take(std::uint64_t page) {
    const auto asked = ask(page);
    ASSERT_TRUE(eventually([&] { return server.join() && server.join()->client != client; })) << "nobody joined";
    const auto join = server.accept();
    client = join->client;
    EXPECT_EQ(join->robots, (std::vector<std::string>{"team/cart"}));
    admit();
    const Answer answer = answer_to(asked);
    EXPECT_TRUE(answer.is_done) << answer.text;
  }
  // The robot is told this when these are the page's newest values.
  Values told(std::uint64_t page, const Values& values) {
    EXPECT_EQ(drive(page, values).text, "drives team/cart");
    const auto answer = server.ask(tick++, {0.0});
    return answer ? answer->values : Values();
  }

  FakeServer server;
  std::optional<Drivers> drivers{std::in_place, Drivers::Options{.domain = server.domain()}};
  std::uint64_t client = 0;  // that was accepted last
  std::uint64_t tick = 0;
};

TEST_F(DriversTest, APageDrivesTheRobotThatItClaims) {
  take(1);
  EXPECT_EQ(told(1, {0.1, 0.05, 0.5, 0.25}), (Values{0.1, 0.05, 0.5, 0.25}));
  EXPECT_EQ(told(1, {}), neutral);
  EXPECT_EQ(drive(1, {0.1}).text, "the robot's command has 4 values, not 1");
  EXPECT_EQ(told(1, {9.0, 0.0, 0.0, 0.0}), (Values{0.2, 0.0, 0.0, 0.0}));
}

TEST_F(DriversTest, APageThatSaysNothingLeavesTheRobotAtItsNeutralValues) {
  take(1);
  EXPECT_EQ(told(1, {0.1, 0.1, 0.5, 0.5}), (Values{0.1, 0.1, 0.5, 0.5}));
  EXPECT_TRUE(eventually([&] {
    const auto answer = server.ask(tick++, {0.0});
    return answer && answer->values == neutral;
  }));
}

TEST_F(DriversTest, WhatTheServerRefusesIsTheAnswer) {
  const auto asked = ask(1);
  ASSERT_TRUE(server.accept());
  server.admit({.status = wire::AdmitStatus::refused, .reason = "team/cart is driven by 'other'"});
  const Answer answer = answer_to(asked);
  EXPECT_FALSE(answer.is_done);
  EXPECT_EQ(answer.text, "refused: team/cart is driven by 'other'");
}

TEST_F(DriversTest, WhoGetsNoAnswerIsToldSo) {
  const Answer answer = drive(1);  // no server accepts
  EXPECT_FALSE(answer.is_done);
  EXPECT_NE(answer.text.find("team/cart could not be claimed"), std::string::npos) << answer.text;
}

TEST_F(DriversTest, OneRobotHasOnePageUntilThatIsSilent) {
  take(1);
  EXPECT_EQ(drive(2).text, "another page drives team/cart");
  EXPECT_EQ(drive(2, {0.1, 0.1, 0.5, 0.5}).text, "another page drives team/cart");
  EXPECT_FALSE(drivers->release({.operation = "release", .name = "team/cart", .visitor = 2}).is_done);
  EXPECT_TRUE(eventually([&] { return drive(2).is_done; }));
  EXPECT_EQ(drive(1, {0.1, 0.1, 0.5, 0.5}).text, "another page drives team/cart");
  EXPECT_EQ(told(2, {0.1, 0.1, 0.5, 0.5}), (Values{0.1, 0.1, 0.5, 0.5}));
}

TEST_F(DriversTest, AResetIsSurvivedAndTheEndOfTheRunIsToldOnce) {
  take(1);
  EXPECT_EQ(told(1, {0.1, 0.1, 0.5, 0.5}), (Values{0.1, 0.1, 0.5, 0.5}));
  admit(2, wire::StartReason::reset);
  EXPECT_EQ(drive(1, {0.2, 0.1, 0.5, 0.5}).text, "drives team/cart");
  const auto answer = server.ask(0, {0.0}, 2);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->values, (Values{0.2, 0.1, 0.5, 0.5}));
  server.report({.kind = wire::ReportKind::finished});
  EXPECT_TRUE(eventually([&] { return drive(1, {0.0, 0.0, 0.5, 0.5}).text == "the run is over"; }));
  EXPECT_EQ(drive(1, {0.0, 0.0, 0.5, 0.5}).text,
            "this page does not drive 'team/cart': claim it with 'drive' without numbers");
}

TEST_F(DriversTest, WhoIsSupersededIsToldByWhom) {
  take(1);
  server.report({.kind = wire::ReportKind::superseded, .text = "by 'other' on host h"});
  std::string text;
  EXPECT_TRUE(eventually([&] {
    const Answer answer = drive(1, neutral);
    text = answer.text;
    return !answer.is_done;
  }));
  EXPECT_EQ(text, "another process took over these robots. by 'other' on host h");
  take(1);
}

TEST_F(DriversTest, ARobotIsLetGoByReleaseByLeavingAndAtTheEnd) {
  take(1);
  EXPECT_TRUE(drivers->release({.operation = "release", .name = "team/cart", .visitor = 1}).is_done);
  EXPECT_FALSE(drive(1, neutral).is_done);
  take(1);
  drivers->leave(2);
  EXPECT_TRUE(drive(1, neutral).is_done);
  drivers->leave(1);
  EXPECT_FALSE(drive(1, neutral).is_done);
  const auto last = ask(1);
  drivers.reset();
  EXPECT_FALSE(answer_to(last).is_done) << "whoever still waits is told";
}

TEST_F(DriversTest, SelectorsAndTooManyRobotsAreRefused) {
  for (const char* name : {"", "all", "3", "0..7", "team/*"})
    EXPECT_NE(drive(1, {}, name).text.find("the full name of one robot"), std::string::npos) << name;
  for (std::size_t robot = 0; robot < Drivers::most; ++robot) ask(1, {}, "team/cart_" + std::to_string(robot));
  EXPECT_EQ(drive(1, {}, "team/one_more").text, "one view can drive at most 8 robots");
}

}  // namespace
}  // namespace cohort::view
