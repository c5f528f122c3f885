// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "client_sdk/src/attachment.hpp"
#include "tests/support/captured_stderr.hpp"
#include "tests/support/counting_controller.hpp"
#include "tests/support/fake_server.hpp"

namespace cohort {
namespace {

using namespace test;

// A client on its own thread, stopped at the latest on destruction.
class RunningClient {
 public:
  RunningClient(std::uint32_t domain, bool inline_step) {
    ClientOptions options;
    options.domain = domain;
    options.robots = {"0", "team/*"};
    options.inline_step = inline_step;
    end_ = std::async(std::launch::async,
                      [this, options] { return run_client(CountingController::plugin(), options, stop); });
  }
  ~RunningClient() { stop = true; }

  // Returns how it ended; empty while it runs.
  std::optional<ClientEnd> end() {
    if (end_.wait_for(patience) != std::future_status::ready) return std::nullopt;
    return end_.get();
  }

  std::atomic<bool> stop{false};

 private:
  std::future<ClientEnd> end_;
};

// The parameter: whether `step` runs on the thread of DDS.
class ClientTest : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    client.emplace(server.domain(), GetParam());
    ASSERT_TRUE(server.accept());
  }

  void admit(std::uint64_t epoch = 1, wire::StartReason reason = wire::StartReason::first) {
    server.describe(CountingController::description());
    server.admit(
        {.epoch = epoch, .start_reason = reason, .step_ns = 10'000'000, .robots = {{.robot = 0, .name = "r0"}}});
  }
  // Returns the answer to a frame: number of steps, tick, twice the reading, start reason.
  std::vector<double> ask(std::uint64_t tick, double reading, std::uint64_t epoch = 1) {
    const auto answer = server.ask(tick, {reading}, epoch);
    if (!answer || answer->values.size() != 6) return {};
    EXPECT_EQ(answer->tick, tick);
    EXPECT_EQ(answer->epoch, epoch);
    return {answer->values.begin(), answer->values.begin() + 4};
  }
  using Values = std::vector<double>;

  CapturedStderr told;  // messages to the user
  FakeServer server;
  std::optional<RunningClient> client;
};

INSTANTIATE_TEST_SUITE_P(, ClientTest, testing::Values(false, true), [](const auto& parameter) {
  return std::string(parameter.param ? "stepping_inline" : "stepping_on_its_own_thread");
});

TEST_P(ClientTest, AJoinContainsTheClientAndItsRobots) {
  const auto join = server.join();
  EXPECT_EQ(join->controller, "counting");
  EXPECT_EQ(join->robots, (std::vector<std::string>{"0", "team/*"}));
  EXPECT_NE(join->client, 0u);
  EXPECT_NE(join->process, 0u);
  EXPECT_FALSE(join->host.empty());
}

TEST_P(ClientTest, EveryFrameIsAnsweredAndOneSentAgainGetsTheSameAnswer) {
  admit();
  EXPECT_EQ(ask(0, 0.5), (Values{1, 0, 1.0, 0}));
  EXPECT_EQ(ask(1, 0.25), (Values{2, 1, 0.5, 0}));
  EXPECT_EQ(ask(1, 0.75), (Values{2, 1, 0.5, 0})) << "from memory, without another step";
  EXPECT_EQ(ask(0, 0.75), (Values{1, 0, 1.0, 0}));
  EXPECT_EQ(ask(2, 0.0), (Values{3, 2, 0.0, 0}));
}

TEST_P(ClientTest, FramesMayArriveBeforeTheAdmissionAndItBeforeTheDescriptions) {
  // Until the frame is known to have arrived: the channel to the client may not be open at first.
  server.send(0, {0.5});
  server.admit({.epoch = 1, .robots = {{.robot = 0, .name = "r0", .description = 7}}});
  server.describe(CountingController::description(7));
  EXPECT_EQ(ask(0, 0.5), (Values{1, 0, 1.0, 0}));
}

TEST_P(ClientTest, ANewEpochStartsTheControllersAgainAndTheOldOneIsNotAnswered) {
  admit(1);
  EXPECT_EQ(ask(0, 0.5, 1), (Values{1, 0, 1.0, 0}));
  admit(2, wire::StartReason::reset);
  EXPECT_EQ(ask(0, 0.5, 2), (Values{2, 0, 1.0, 2})) << "the same controller";
  server.send(1, {0.5}, 1);
  admit(3, wire::StartReason::takeover);
  EXPECT_EQ(ask(5, 0.5, 3), (Values{1, 5, 1.0, 1})) << "a new controller";
  for (const auto& answer : server.answers()) EXPECT_FALSE(answer.epoch == 1 && answer.tick == 1);
}

TEST_P(ClientTest, ARefusedClaimEndsTheClientWithTheReason) {
  server.admit({.status = wire::AdmitStatus::refused, .reason = "robot 0 is driven by 'other'"});
  EXPECT_EQ(client->end(), ClientEnd::refused);
  EXPECT_TRUE(told.contains("robot 0 is driven by 'other'")) << told.text();
}

TEST_P(ClientTest, TheServerEndsTheRun) {
  admit();
  ask(0, 0.5);
  server.report({.kind = wire::ReportKind::finished});
  EXPECT_EQ(client->end(), ClientEnd::finished);
  EXPECT_EQ(told.text(), "");
}

TEST_P(ClientTest, AnotherProcessTakesOver) {
  admit();
  server.report({.kind = wire::ReportKind::superseded, .text = "by 'other' on host h"});
  EXPECT_EQ(client->end(), ClientEnd::superseded);
  EXPECT_TRUE(told.contains("by 'other' on host h")) << told.text();
}

TEST_P(ClientTest, ARejectedAnswerIsLoggedOncePerReasonAndTheRunContinues) {
  admit();
  ask(0, 0.5);
  for (std::uint64_t tick = 0; tick < 3; ++tick) {
    server.report({.kind = wire::ReportKind::rejected, .tick = tick, .reason = "stale", .text = "too late"});
  }
  server.report({.kind = wire::ReportKind::rejected, .reason = "early"});
  EXPECT_EQ(ask(1, 0.5), (Values{2, 1, 1.0, 0}));
  server.report({.kind = wire::ReportKind::failed, .text = "enough"});
  EXPECT_EQ(client->end(), ClientEnd::failed);
  const std::string text = told.text();
  EXPECT_NE(text.find("stale"), std::string::npos);
  EXPECT_EQ(text.find("stale"), text.rfind("stale"));
  EXPECT_NE(text.find("early"), std::string::npos);
  EXPECT_NE(text.find("enough"), std::string::npos);
}

TEST_P(ClientTest, AnExceptionOfAControllerIsReportedToTheServerAndTheUser) {
  admit();
  ask(0, 0.5);
  server.send(1, {-1.0});
  EXPECT_EQ(client->end(), ClientEnd::failed);
  ASSERT_TRUE(eventually([&] { return server.heard_report().has_value(); }));
  const wire::Report report = *server.heard_report();
  EXPECT_EQ(report.kind, wire::ReportKind::failed);
  EXPECT_EQ(report.reason, "exception");
  EXPECT_EQ(report.tick, 1u);
  EXPECT_NE(report.text.find("robot 'r0' failed in step at tick 1: it hurts"), std::string::npos);
  EXPECT_TRUE(told.contains(report.text)) << told.text();
}

TEST_P(ClientTest, AServerThatLeavesWithoutNoticeIsDetected) {
  admit();
  ask(0, 0.5);
  server.leave();
  EXPECT_EQ(client->end(), ClientEnd::server_lost);
  EXPECT_TRUE(told.contains("is gone")) << told.text();
}

TEST_P(ClientTest, AStopEndsTheClient) {
  admit();
  ask(0, 0.5);
  client->stop = true;
  EXPECT_EQ(client->end(), ClientEnd::interrupted);
}

// Steps slowly, and records the thread.
class SlowController final : public Controller {
 public:
  explicit SlowController(std::vector<std::thread::id>& threads) : threads_(threads) {}
  void start(const Start&) override {}
  void step(const Observation&, Command&) override {
    threads_.push_back(std::this_thread::get_id());
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(2);
    while (std::chrono::steady_clock::now() < end) continue;
  }

 private:
  std::vector<std::thread::id>& threads_;
};

TEST(ClientAlone, LongStepsDoNotRunOnTheDdsThread) {
  std::vector<std::thread::id> threads;  // thread of each step; steps do not overlap
  const ControllerKind slow{
      "slow",
      [&] { return OwnedController(new SlowController(threads), [](Controller* controller) { delete controller; }); }};
  FakeServer server;
  ClientOptions options;
  options.domain = server.domain();
  options.inline_step = true;
  const std::atomic<bool> stop{false};
  std::thread::id own;
  auto end = std::async(std::launch::async, [&] {
    own = std::this_thread::get_id();
    return run_client(slow, options, stop);
  });
  ASSERT_TRUE(server.accept());
  server.describe(CountingController::description());
  server.admit({.epoch = 1, .step_ns = 10'000'000, .robots = {{.robot = 0, .name = "r0"}}});
  constexpr std::uint64_t frames = 20;
  for (std::uint64_t tick = 0; tick < frames; ++tick) ASSERT_TRUE(server.ask(tick, {0.5}, 1).has_value());
  server.report({.kind = wire::ReportKind::finished});
  ASSERT_EQ(end.get(), ClientEnd::finished);
  ASSERT_EQ(threads.size(), frames);
  EXPECT_NE(std::count(threads.begin(), threads.end(), own), static_cast<std::ptrdiff_t>(frames));
  EXPECT_EQ(std::count(threads.end() - 5, threads.end(), own), 5);
}

TEST(ClientAlone, WaitsForAServerAndFindsItWhenItStarts) {
  const std::uint32_t domain = find_empty_domain();
  const CapturedStderr told;
  RunningClient client(domain, false);
  ASSERT_TRUE(eventually([&] { return told.contains("waiting for a server at 127.0.0.1, domain"); }));
  auto participant = take_free_domain(domain, domain).server;
  std::atomic<bool> joined{false};
  wire::Reader<wire::Join> joins(participant,
                                 {[&](const wire::Join&, const wire::Sender&) { joined = true; }, nullptr});
  EXPECT_TRUE(eventually([&] { return joined.load(); }));
}

TEST(ClientAlone, CanBeStoppedWhileItWaitsForAServer) {
  const CapturedStderr told;
  RunningClient client(find_empty_domain(), false);
  client.stop = true;
  EXPECT_EQ(client.end(), ClientEnd::interrupted);
}

}  // namespace
}  // namespace cohort
