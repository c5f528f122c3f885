// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <future>
#include <string>
#include <utility>
#include <vector>

#include "client_sdk/include/cohort/cohort.h"
#include "tests/support/captured_stderr.hpp"
#include "tests/support/counting_controller.hpp"
#include "tests/support/fake_server.hpp"

namespace cohort {
namespace {

using namespace test;

// A firmware-like loop on its own thread, so that the test can be the server.
class CClientTest : public testing::Test {
 protected:
  void SetUp() override {
    const CohortOptions options = {nullptr, server.domain(), "0,team/*", "loop", nullptr};
    client = cohort_connect(&options);
    ASSERT_NE(client, nullptr);
    ASSERT_TRUE(server.accept());
    server.describe(CountingController::description());
  }
  ~CClientTest() override { cohort_close(client); }

  void admit(std::uint64_t epoch = 1, wire::StartReason reason = wire::StartReason::first) {
    server.admit({.epoch = epoch,
                  .start_reason = reason,
                  .step_ns = 10'000'000,
                  .robots = {{.robot = 0, .name = "r0"}, {.robot = 4, .name = "r4"}}});
  }
  void admit_with(std::vector<wire::Parameter> parameters) {
    server.admit({.epoch = 1,
                  .step_ns = 10'000'000,
                  .teams = {{.name = "team", .controller = "other", .parameters = std::move(parameters)}},
                  .robots = {{.robot = 0, .name = "r0"}, {.robot = 4, .name = "r4"}}});
  }
  // Returns the next event; fails the test and closes the client instead of waiting without limit.
  CohortEvent next() {
    CohortEvent event{};
    auto coming = std::async(std::launch::async, [&] {
      cohort_next(client, &event);
      error = cohort_last_error();
    });
    if (coming.wait_for(patience) != std::future_status::ready) {
      ADD_FAILURE() << "no event came";
      std::abort();
    }
    return event;
  }
  void take_starts(CohortStartReason reason) {
    for (const std::uint32_t robot : {0u, 4u}) {
      const CohortEvent event = next();
      ASSERT_EQ(event.kind, cohort_event_start);
      EXPECT_EQ(event.robot, robot);
      EXPECT_EQ(cohort_start_info(event.start)->robot, robot);
      EXPECT_EQ(cohort_start_info(event.start)->reason, reason);
      reading = cohort_find_observation(event.start, "sensor/0/reading");
      doubled = cohort_find_command(event.start, "count/0/doubled");
    }
  }
  // Sends a frame until it is known to have arrived.
  CohortEvent take_frame(std::uint64_t tick, std::uint64_t epoch = 1) {
    auto coming = std::async(std::launch::async, [&] { return next(); });
    while (coming.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready)
      server.send(tick, {0.5, 0.25}, epoch, {0, 4});
    return coming.get();
  }
  void answer_double(const CohortEvent& event, std::uint32_t robot) {
    ASSERT_EQ(event.kind, cohort_event_observation);
    EXPECT_EQ(event.robot, robot);
    cohort_set(event.command, doubled, 2.0 * cohort_read(event.observation, reading));
    cohort_answer(client);
    cohort_answer(client);  // changes nothing
  }

  CapturedStderr told;
  FakeServer server;
  CohortClient* client = nullptr;
  CohortObservationChannel reading{};
  CohortCommandChannel doubled{};
  std::string error;
};

TEST_F(CClientTest, ALoopReceivesStartsAndObservationsAndItsAnswersArrive) {
  EXPECT_EQ(server.join()->controller, "loop");
  EXPECT_EQ(server.join()->robots, (std::vector<std::string>{"0", "team/*"}));
  admit();
  take_starts(cohort_start_first);
  answer_double(take_frame(0), 0);
  answer_double(next(), 4);
  ASSERT_TRUE(eventually([&] { return !server.answers().empty(); }));
  EXPECT_EQ(server.answers()[0].values, (std::vector<double>{0, 0, 1.0, 0, 0.25, 0.25, 0, 0, 0.5, 0, 0.25, 0.25}));

  admit(2, wire::StartReason::reset);
  take_starts(cohort_start_reset);
  answer_double(take_frame(0, 2), 0);
  EXPECT_EQ(next().robot, 4u);
  server.report({.kind = wire::ReportKind::finished});
  const CohortEvent end = next();  // which also answers what came before it
  EXPECT_EQ(end.kind, cohort_event_end);
  EXPECT_EQ(end.end, cohort_end_finished);
  EXPECT_EQ(next().kind, cohort_event_end) << "and stays so";
  EXPECT_TRUE(eventually([&] { return server.answers().back().epoch == 2; }));
}

TEST_F(CClientTest, AFailedLookupEndsTheLoopAndIsReportedToTheServer) {
  admit();
  const CohortEvent event = next();
  EXPECT_EQ(cohort_find_command(event.start, "count/0/dubled").size, 0u);
  const CohortEvent end = next();
  EXPECT_EQ(end.kind, cohort_event_end);
  EXPECT_EQ(end.end, cohort_end_failed);
  EXPECT_NE(error.find("has no command channel 'count/0/dubled'; the nearest are count/0/doubled"), std::string::npos)
      << error;
  EXPECT_TRUE(told.contains("loop: "));
  ASSERT_TRUE(eventually([&] { return server.heard_report().has_value(); }));
  EXPECT_EQ(server.heard_report()->kind, wire::ReportKind::failed);
}

TEST_F(CClientTest, ALoopThatReadsNoParametersDrivesRobotsWhoseParametersAreForAnotherController) {
  admit_with({{"gain", {"2"}}, {"speed", {"3"}}});
  take_starts(cohort_start_first);
  EXPECT_EQ(take_frame(0).kind, cohort_event_observation);
}

TEST_F(CClientTest, ALoopThatReadsAllParametersOfOneRobotNeedNotReadThoseOfTheOther) {
  admit_with({{"gain", {"2"}}, {"speed", {"3"}}});
  EXPECT_EQ(next().robot, 0u);
  const CohortEvent event = next();
  ASSERT_EQ(event.kind, cohort_event_start);
  EXPECT_EQ(cohort_needed_real(event.start, "gain"), 2.0);
  EXPECT_EQ(cohort_real(event.start, "speed", 1.0), 3.0);
  EXPECT_EQ(take_frame(0).kind, cohort_event_observation);
}

TEST_F(CClientTest, AParameterThatALoopLeavesOutEndsItIfItReadsAnother) {
  admit_with({{"gian", {"2"}}});
  EXPECT_EQ(next().robot, 0u);
  const CohortEvent event = next();
  ASSERT_EQ(event.kind, cohort_event_start);
  EXPECT_EQ(cohort_real(event.start, "gain", 1.0), 1.0);
  const CohortEvent end = next();
  EXPECT_EQ(end.kind, cohort_event_end);
  EXPECT_EQ(end.end, cohort_end_failed);
  EXPECT_NE(
      error.find("robot 'r4' failed in start at tick 0: parameter 'gian': unknown parameter; the nearest are gain"),
      std::string::npos)
      << error;
  ASSERT_TRUE(eventually([&] { return server.heard_report().has_value(); }));
  EXPECT_EQ(server.heard_report()->kind, wire::ReportKind::failed);
}

TEST_F(CClientTest, ARefusedClaimEndsTheLoopWithTheReason) {
  server.admit({.status = wire::AdmitStatus::refused, .reason = "robot 0 is driven by 'other'"});
  EXPECT_EQ(next().end, cohort_end_refused);
  EXPECT_NE(error.find("robot 0 is driven by 'other'"), std::string::npos) << error;
}

TEST_F(CClientTest, ClosingInTheMiddleOfATickLeavesWithoutAnAnswerAndIsNoFailure) {
  admit();
  take_starts(cohort_start_first);
  EXPECT_EQ(take_frame(0).kind, cohort_event_observation);
  cohort_close(client);
  client = nullptr;
  EXPECT_TRUE(server.answers().empty());
  EXPECT_FALSE(server.heard_report().has_value());
  EXPECT_EQ(told.text(), "");
}

TEST(CClientAlone, CanBeClosedWhileItWaitsForAServer) {
  const CohortOptions options = {nullptr, find_empty_domain(), nullptr, nullptr, nullptr};
  cohort_close(cohort_connect(&options));
  cohort_close(nullptr);
}

TEST(CClientAlone, InvalidOptionsAreReported) {
  const CapturedStderr told;
  const CohortOptions nobody = {nullptr, 0, ",", nullptr, nullptr};
  EXPECT_EQ(cohort_connect(&nobody), nullptr);
  EXPECT_STREQ(cohort_last_error(), "the option 'robots' is empty; expected at least one selector");

  const CohortOptions nowhere = {"no such host", 1, nullptr, nullptr, nullptr};
  CohortClient* client = cohort_connect(&nowhere);
  CohortEvent event{};
  EXPECT_EQ(cohort_next(client, &event), cohort_event_end);
  EXPECT_EQ(event.end, cohort_end_failed);
  EXPECT_NE(std::string(cohort_last_error()).find("no such host"), std::string::npos) << cohort_last_error();
  cohort_close(client);
}

}  // namespace
}  // namespace cohort
