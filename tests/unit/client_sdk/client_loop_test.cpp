// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <poll.h>

#include <chrono>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "client_sdk/include/cohort/client.hpp"
#include "client_sdk/src/hand_over.hpp"
#include "client_sdk/src/loop_host.hpp"
#include "tests/support/captured_stderr.hpp"
#include "tests/support/counting_controller.hpp"
#include "tests/support/fake_server.hpp"

namespace cohort {
namespace {

using namespace test;

class ClientLoopTest : public testing::Test {
 protected:
  void SetUp() override {
    client.emplace(ClientOptions{.domain = server.domain(), .robots = {"0", "4"}, .name = "loop"});
    ASSERT_TRUE(server.accept());
    server.describe(CountingController::description());
  }
  void admit(std::uint64_t epoch = 1, wire::StartReason reason = wire::StartReason::first) {
    server.admit({.epoch = epoch,
                  .start_reason = reason,
                  .tick = 20,
                  .step_ns = 10'000'000,
                  .robots = {{.robot = 4, .name = "r4", .period = 5, .phase = 2, .delay = 1, .mode = wire::Mode::free},
                             {.robot = 0, .name = "r0"}}});
  }
  void admit_with(std::vector<wire::Parameter> parameters) {
    server.admit({.epoch = 1,
                  .step_ns = 10'000'000,
                  .teams = {{.name = "team", .controller = "other", .parameters = std::move(parameters)}},
                  .robots = {{.robot = 0, .name = "r0"}, {.robot = 4, .name = "r4"}}});
  }
  template <class Event>
  Event next() {
    std::optional<ClientEvent> event = client->next(patience);
    if (!event || !std::holds_alternative<Event>(*event)) {
      ADD_FAILURE() << (event ? "another event came" : "no event came");
      return {};
    }
    return std::get<Event>(*event);
  }
  // Sends a frame until it is known to have arrived.
  Frame take_frame(std::uint64_t tick) {
    for (;;) {
      server.send(tick, {0.5, 0.25}, 1, {0, 4});
      if (const auto event = client->next(std::chrono::milliseconds(50))) return std::get<Frame>(*event);
    }
  }

  CapturedStderr told;
  FakeServer server;
  std::optional<Client> client;
};

TEST_F(ClientLoopTest, ALeaseHasAllRobotsWithTheirPolicies) {
  admit();
  const auto lease = next<LeaseStart>();
  EXPECT_EQ(lease.tick, 20u);
  EXPECT_EQ(lease.step, std::chrono::milliseconds(10));
  ASSERT_EQ(lease.robots.size(), 2u);
  EXPECT_EQ(lease.robots[0].start.name, "r0");
  EXPECT_TRUE(lease.robots[0].policy.waits);
  EXPECT_EQ(lease.robots[0].policy.period, 1u);
  EXPECT_EQ(lease.robots[1].start.name, "r4");
  EXPECT_EQ(lease.robots[1].start.reason, StartReason::first);
  EXPECT_FALSE(lease.robots[1].policy.waits);
  EXPECT_EQ(lease.robots[1].policy.period, 5u);
  EXPECT_EQ(lease.robots[1].policy.phase, 2u);
  EXPECT_EQ(lease.robots[1].policy.delay, 1u);

  admit(2, wire::StartReason::reset);
  EXPECT_EQ(next<LeaseStart>().robots[0].start.reason, StartReason::reset);
}

TEST_F(ClientLoopTest, AFrameIsAnsweredAsAWholeAndUnsetCommandsAreNeutral) {
  admit();
  const auto lease = next<LeaseStart>();
  const ObservationChannel reading = lease.robots[0].start.observation("sensor/0/reading");
  const CommandChannel doubled = lease.robots[0].start.command("count/0/doubled");
  const Frame frame = take_frame(20);
  EXPECT_EQ(frame.tick, 20u);
  ASSERT_EQ(frame.robots.size(), 2u);
  EXPECT_EQ(frame.robots[1].robot->start.name, "r4");
  frame.robots[1].command.set(doubled, 2.0 * frame.robots[1].observation[reading]);
  EXPECT_TRUE(server.answers().empty());
  client->answer();
  client->answer();  // changes nothing
  ASSERT_TRUE(eventually([&] { return !server.answers().empty(); }));
  EXPECT_EQ(server.answers()[0].values, (std::vector<double>{0, 0, 0, 0, 0.25, 0.25, 0, 0, 0.5, 0, 0.25, 0.25}));
}

TEST_F(ClientLoopTest, ALoopThatReadsNoParametersDrivesRobotsWhoseParametersAreForAnotherController) {
  admit_with({{"gain", {"2"}}, {"speed", {"3"}}});
  EXPECT_EQ(next<LeaseStart>().robots[0].start.parameters.all().size(), 2u);
  EXPECT_EQ(take_frame(0).tick, 0u);
}

TEST_F(ClientLoopTest, ALoopThatReadsAllParametersOfOneRobotNeedNotReadThoseOfTheOther) {
  admit_with({{"gain", {"2"}}, {"speed", {"3"}}});
  const auto lease = next<LeaseStart>();
  EXPECT_EQ(lease.robots[1].start.parameters.real("gain"), 2.0);
  EXPECT_EQ(lease.robots[1].start.parameters.real("speed", 1.0), 3.0);
  EXPECT_EQ(take_frame(0).tick, 0u);
}

TEST_F(ClientLoopTest, AParameterThatALoopLeavesOutEndsItIfItReadsAnother) {
  admit_with({{"gian", {"2"}}});
  EXPECT_EQ(next<LeaseStart>().robots[1].start.parameters.real("gain", 1.0), 1.0);
  const auto ended = next<ClientEnded>();
  EXPECT_EQ(ended.end, ClientEnd::failed);
  EXPECT_NE(ended.why.find("robot 'r4' failed in start at tick 0: parameter 'gian': unknown parameter; the nearest are "
                           "gain"),
            std::string::npos)
      << ended.why;
  ASSERT_TRUE(eventually([&] { return server.heard_report().has_value(); }));
  EXPECT_EQ(server.heard_report()->kind, wire::ReportKind::failed);
}

TEST_F(ClientLoopTest, OnlyAFrameOfFreeRobotsMayBeLeftUnanswered) {
  admit();
  next<LeaseStart>();
  EXPECT_THROW(client->leave_unanswered(), std::logic_error) << "no frame";
  take_frame(20);
  EXPECT_THROW(client->leave_unanswered(), std::logic_error) << "robot 0 is in lockstep";
  server.admit({.epoch = 2,
                .tick = 30,
                .step_ns = 10'000'000,
                .robots = {{.robot = 0, .name = "r0", .mode = wire::Mode::free},
                           {.robot = 4, .name = "r4", .mode = wire::Mode::free}}});
  client->answer();
  next<LeaseStart>();
  const auto take = [&](std::uint64_t tick) {
    for (;;) {
      server.send(tick, {0.5, 0.25}, 2, {0, 4});
      if (const auto event = client->next(std::chrono::milliseconds(50))) return std::get<Frame>(*event).tick;
    }
  };
  EXPECT_EQ(take(30), 30u);
  client->leave_unanswered();
  EXPECT_EQ(take(31), 31u);
  client->answer();
  ASSERT_TRUE(eventually([&] { return !server.answers().empty() && server.answers().back().tick == 31; }));
  for (const auto& answer : server.answers()) EXPECT_NE(answer.tick, 30u);
}

TEST_F(ClientLoopTest, ItsDescriptorIsReadableWhileAnEventWaits) {
  const auto is_readable = [&](int milliseconds) {
    pollfd watched{client->descriptor(), POLLIN, 0};
    return ::poll(&watched, 1, milliseconds) == 1;
  };
  EXPECT_FALSE(is_readable(0));
  EXPECT_FALSE(client->next(std::chrono::milliseconds(0)));
  admit();
  EXPECT_TRUE(is_readable(std::chrono::duration_cast<std::chrono::milliseconds>(patience).count()));
  next<LeaseStart>();
  EXPECT_FALSE(is_readable(0));
  client->answer();
  server.report({.kind = wire::ReportKind::finished});
  EXPECT_EQ(next<ClientEnded>().end, ClientEnd::finished);
  EXPECT_TRUE(is_readable(0)) << "the end is there each time";
  EXPECT_EQ(next<ClientEnded>().why, "");
}

TEST_F(ClientLoopTest, DetectsThatItsAnswerIsNoLongerNeeded) {
  admit();
  next<LeaseStart>();
  take_frame(20);
  EXPECT_FALSE(client->is_over());
  server.report({.kind = wire::ReportKind::superseded, .text = "by another"});
  EXPECT_TRUE(eventually([&] { return client->is_over(); }));
  const auto ended = next<ClientEnded>();
  EXPECT_EQ(ended.end, ClientEnd::superseded);
  EXPECT_NE(ended.why.find("by another"), std::string::npos) << ended.why;
}

TEST_F(ClientLoopTest, ReportsToTheServerWhyItCannotDriveItsRobots) {
  admit();
  next<LeaseStart>();
  client->fail("no gripper");
  const auto ended = next<ClientEnded>();
  EXPECT_EQ(ended.end, ClientEnd::failed);
  EXPECT_EQ(ended.why, "no gripper");
  ASSERT_TRUE(eventually([&] { return server.heard_report().has_value(); }));
  EXPECT_EQ(server.heard_report()->reason, wire::failed_in_start);
  EXPECT_EQ(server.heard_report()->text, "no gripper");
}

TEST_F(ClientLoopTest, LeavesWithoutAnAnswerInTheMiddleOfATick) {
  admit();
  next<LeaseStart>();
  take_frame(20);
  client.reset();
  EXPECT_TRUE(server.answers().empty());
  EXPECT_FALSE(server.heard_report().has_value());
  EXPECT_EQ(told.text(), "");
}

TEST(ClientLoop, WaitsForTheTreesOfAServerThatSendsThem) {
  FakeServer server;
  server.send_trees();
  Client client({.domain = server.domain(), .robots = {"0"}});
  ASSERT_TRUE(server.accept());
  server.describe(CountingController::description(7));
  server.admit({.epoch = 1, .step_ns = 10'000'000, .robots = {{.robot = 0, .name = "r0", .description = 7}}});
  const KinematicTree tree{.links = {{"hull", 0.4, {}}}, .joints = {}, .sensors = {}};
  server.send(wire::RobotTree{8, tree});  // another description
  EXPECT_FALSE(client.next(std::chrono::milliseconds(300)));
  server.send(wire::RobotTree{7, tree});
  const std::optional<ClientEvent> event = client.next(patience);
  ASSERT_TRUE(event && std::holds_alternative<LeaseStart>(*event));
  EXPECT_EQ(std::get<LeaseStart>(*event).robots[0].start.tree, tree);
}

TEST_F(ClientLoopTest, AServerOfAnOlderVersionGivesNoTree) {
  admit();
  EXPECT_EQ(next<LeaseStart>().robots[0].start.tree, KinematicTree{});
}

TEST(ClientLoop, EndsIfItsServerCannotBeFound) {
  const CapturedStderr told;
  Client client({.server = "no such host", .domain = 1});
  const ClientEvent event = client.next();
  EXPECT_EQ(std::get<ClientEnded>(event).end, ClientEnd::failed);
  EXPECT_NE(std::get<ClientEnded>(event).why.find("no such host"), std::string::npos);
  EXPECT_TRUE(told.contains("client: "));
}

// States of a loop without a network: the host runs on another thread, the loop here.
class StatesOfLoops : public testing::Test {
 protected:
  void start(LoopHost& host, HandOver& loop) {
    wire::Admit admit;
    admit.robots = {{.robot = 3, .name = "r3"}, {.robot = 7, .name = "r7"}};
    const std::vector<wire::RobotDescription> descriptions = {CountingController::description()};
    auto starting = std::async(std::launch::async, [&] { host.start(admit, descriptions); });
    loop.take(std::nullopt);
    loop.answer();
    starting.get();
  }

  HandOver first_loop;
  LoopHost first{"loop", first_loop};
};

TEST_F(StatesOfLoops, AreSavedAndLoadedRobotByRobot) {
  start(first, first_loop);
  auto saving = std::async(std::launch::async, [&] { return first.save(); });
  for (const int remembered : {30, 70}) {
    std::get<SaveState>(*first_loop.take(std::nullopt)).state->write(remembered);
    first_loop.answer();
  }
  const std::vector<RobotState> states = saving.get();

  HandOver second_loop;
  LoopHost second("loop", second_loop);
  start(second, second_loop);
  auto loading = std::async(std::launch::async, [&] { return second.load(states); });
  for (const int remembered : {30, 70}) {
    const auto event = std::get<LoadState>(*second_loop.take(std::nullopt));
    int read = 0;
    event.state->read(read);
    EXPECT_EQ(read, remembered);
    EXPECT_EQ(event.robot->start.name, remembered == 30 ? "r3" : "r7");
    second_loop.answer();
  }
  EXPECT_TRUE(loading.get().empty());

  LoopHost other("another", second_loop);
  start(other, second_loop);
  const std::vector<std::string> notices = other.load(states);
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_NE(notices[0].find("'loop'; 'another' cannot load it"), std::string::npos) << notices[0];
}

TEST_F(StatesOfLoops, MustBeReadCompletelyAndHaveALimit) {
  start(first, first_loop);
  auto loading = std::async(std::launch::async, [&] {
    return first.load(std::vector<RobotState>{{3, ControllerState{"loop", std::vector<std::byte>(5)}}});
  });
  first_loop.take(std::nullopt);
  first_loop.answer();
  EXPECT_THROW(loading.get(), ControllerFailure);

  auto saving = std::async(std::launch::async, [&] { return first.save(); });
  std::get<SaveState>(*first_loop.take(std::nullopt)).state->write(std::string(largest_state, 'x'));
  first_loop.answer();
  EXPECT_THROW(saving.get(), SaveFailure);
}

}  // namespace
}  // namespace cohort
