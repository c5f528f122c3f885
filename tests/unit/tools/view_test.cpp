// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/view/sources/control_requests.hpp"
#include "tools/view/sources/live_history.hpp"
#include "tools/view/web/admission.hpp"
#include "tools/view/web/client_session.hpp"

namespace cohort::view {
namespace {

using nlohmann::json;

recording::Bytes some(std::size_t size) { return recording::Bytes(size); }

// A session whose requests are kept.
struct Visit {
  Topics topics;
  std::vector<ViewRequest> requests;
  ClientSession session{topics,
                        "test",
                        "session",
                        {[this](const auto&, const ViewRequest& request) { requests.push_back(request); }, [] {}}};

  Visit() {
    for (int greeting = 0; greeting < 3; ++greeting) session.next();
  }
  json next_text() {
    const auto next = session.next();
    return next && std::holds_alternative<ClientSession::Text>(*next)
               ? json::parse(std::get<ClientSession::Text>(*next).text)
               : json();
  }
  // The version of the message that comes next, 0 if none does.
  std::uint64_t next_version() {
    const auto next = session.next();
    return next ? std::get<ClientSession::Data>(*next).published->version : 0;
  }
};

TEST(ViewSession, GreetsWithItsChannelsAndServices) {
  Topics topics;
  ClientSession session(topics, "test", "1", {});
  const auto operation = [&] { return json::parse(std::get<ClientSession::Text>(session.next().value()).text)["op"]; };
  EXPECT_EQ(operation(), "serverInfo");
  EXPECT_EQ(operation(), "advertise");
  EXPECT_EQ(operation(), "advertiseServices");
  EXPECT_FALSE(session.next());
}

TEST(ViewSession, WhoReadsSlowlyGetsTheNewestOnly) {
  Visit visit;
  visit.topics.publish(Topic::frame, {}, some(10));
  visit.session.take_text(R"({"op": "subscribe", "subscriptions": [{"id": 5, "channelId": 1}]})");
  EXPECT_EQ(visit.next_version(), 1U);  // the earlier version
  for (int i = 0; i < 1000; ++i) visit.topics.publish(Topic::frame, {}, some(10));
  EXPECT_EQ(visit.next_version(), 1001U);
  EXPECT_EQ(visit.next_version(), 0U);
}

TEST(ViewSession, ABusyTopicKeepsNoOtherBack) {
  Visit visit;
  visit.session.take_text(
      R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 1}, {"id": 2, "channelId": 4}]})");
  visit.topics.publish(Topic::status, {}, some(1));
  int statuses = 0;
  for (int i = 0; i < 4; ++i) {
    visit.topics.publish(Topic::frame, {}, some(10));
    const auto next = visit.session.next();
    ASSERT_TRUE(next);
    statuses += std::get<ClientSession::Data>(*next).published->data.size() == 1 ? 1 : 0;
  }
  EXPECT_EQ(statuses, 1);
}

TEST(ViewSession, CountsWhoReadsATopic) {
  Topics topics;
  {
    ClientSession session(topics, "test", "1", {});
    session.take_text(R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 3}]})");
    EXPECT_TRUE(topics.is_read(Topic::contacts));
    session.take_text(R"({"op": "unsubscribe", "subscriptionIds": [1]})");
    EXPECT_FALSE(topics.is_read(Topic::contacts));
    session.take_text(R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 3}]})");
  }
  EXPECT_FALSE(topics.is_read(Topic::contacts));
}

TEST(ViewSession, AnswersThatNobodyReadsAreBounded) {
  Visit visit;
  for (int i = 0; i < 10'000; ++i) visit.session.take_text("nonsense");
  std::size_t replies = 0;
  while (visit.session.next()) ++replies;
  EXPECT_EQ(replies, ClientSession::most_replies);
}

TEST(ViewSession, TellsWhatIsWrongWithAMessage) {
  Visit visit;
  visit.session.take_text(R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 77}]})");
  EXPECT_EQ(visit.next_text()["message"], "no channel 77");
  visit.session.take_text(R"({"op": "getParameters"})");
  EXPECT_EQ(visit.next_text()["message"], "the operation 'getParameters' is not offered");
  EXPECT_TRUE(visit.requests.empty());
}

TEST(ViewAdmission, OnlyOurPageAndProgramsMayConnect) {
  const Admission ours{true, "", {"https://app.foxglove.dev"}};
  EXPECT_FALSE(refusal(ours, {"localhost:8080", std::nullopt, "/"}));
  EXPECT_FALSE(refusal(ours, {"127.0.0.1:8080", "http://127.0.0.1:8080", "/"}));
  EXPECT_FALSE(refusal(ours, {"[::1]:8080", "https://app.foxglove.dev", "/"}));
  EXPECT_TRUE(refusal(ours, {"localhost:8080", "http://localhost:9090", "/"}));
  EXPECT_TRUE(refusal(ours, {"localhost:8080", "null", "/"}));
  EXPECT_TRUE(refusal(ours, {"stranger.example:8080", std::nullopt, "/"}));
  EXPECT_TRUE(refusal(ours, {"localhost.stranger.example", std::nullopt, "/"}));
}

TEST(ViewAdmission, ATokenIsWholeOrWrong) {
  const Admission network{false, "secret", {}};
  const auto is_let_in = [&](const std::string& target) {
    return !refusal(network, {"robot.lan:8080", std::nullopt, target});
  };
  EXPECT_TRUE(is_let_in("/?token=secret"));
  EXPECT_TRUE(is_let_in("/?more=1&token=secret&x"));
  for (const char* target : {"/", "/?token=", "/?token=secre", "/?token=secrets", "/?xtoken=secret", "/token=secret"})
    EXPECT_FALSE(is_let_in(target)) << target;
  EXPECT_EQ(random_token().size(), 32U);
  EXPECT_NE(random_token(), random_token());
}

TEST(ViewRequests, BecomeRequestsOrAreExplained) {
  EXPECT_EQ(operation_of({.operation = "pause"}),
            wire::Operation(wire::SetSimulationState{wire::SimulationState::paused}));
  EXPECT_EQ(operation_of({.operation = "step", .number = 3.0}), wire::Operation(wire::StepSimulation{3}));
  EXPECT_EQ(operation_of({.operation = "move", .name = "bar", .numbers = {1.0, 2.0}}),
            wire::Operation(wire::SetEntityState{.entity = "bar", .pose = wire::Pose{{1.0, 2.0, 0.0}, {}}}));
  EXPECT_EQ(operation_of({.operation = "spawn", .name = "new", .text = "bar", .numbers = {1.0, 2.0}}),
            wire::Operation(wire::SpawnEntity{.entity = "new", .uri = "bar", .pose = {{1.0, 2.0, 0.0}, {}}}))
      << "a model of the world, never the text of one";
  const auto turned = std::get<wire::SetEntityState>(
      operation_of({.operation = "move", .name = "bar", .numbers = {1.0, 2.0, 0.5, 3.0}}));
  EXPECT_DOUBLE_EQ(2.0 * std::atan2(turned.pose->orientation.z, turned.pose->orientation.w), 3.0);
  EXPECT_THROW(operation_of({.operation = "move", .name = "bar", .numbers = {1.0}}), std::invalid_argument);
  EXPECT_THROW(operation_of({.operation = "move", .numbers = {1.0, 2.0}}), std::invalid_argument);
  EXPECT_THROW(operation_of({.operation = "step", .number = 0.0 / 0.0}), std::invalid_argument);
  EXPECT_EQ(operation_of({.operation = "shutdown"}),
            wire::Operation(wire::SetSimulationState{wire::SimulationState::quitting}));
  EXPECT_THROW(operation_of({.operation = "explode"}), std::invalid_argument);
}

// The answer of a server whose run has come this far.
wire::Reply told(std::uint32_t run, std::uint64_t revision, const messages::RunHistory& history) {
  wire::Reply reply;
  reply.run = run;
  auto& part = reply.returned.emplace<wire::HistoryPart>();
  part.revision = revision;
  for (const std::byte each : messages::encode(history)) part.data.push_back(static_cast<std::uint8_t>(each));
  return reply;
}

std::vector<std::string> texts(const ViewEvents& events) {
  std::vector<std::string> texts;
  for (const ViewEvent& event : events.events) texts.push_back(event.text);
  return texts;
}

using Texts = std::vector<std::string>;
constexpr std::chrono::milliseconds step{10};

TEST(ViewHistory, WhatHappensAgainIsCountedAndTheLastStandsAtTheEnd) {
  LiveHistory history;
  EXPECT_TRUE(history.take(told(1, 2, {0, 0, 0, 0, {{3, 3, 1, "missed", "a"}, {5, 5, 1, "joined", "b"}}}), step));
  EXPECT_EQ(history.question().revision, 2U);
  EXPECT_FALSE(history.take(told(1, 2, {}), step));
  EXPECT_TRUE(history.take(told(1, 3, {0, 0, 0, 0, {{3, 9, 2, "missed", "a"}}}), step));
  EXPECT_EQ(texts(history.events()), (Texts{"b", "a"}));
  const ViewEvent& again = history.events().events.back();
  EXPECT_EQ(again.count, 2U);
  EXPECT_EQ(again.time_ns, 30'000'000);
  EXPECT_EQ(again.last_ns, 90'000'000);
  EXPECT_FALSE(history.can_go_back());
}

TEST(ViewHistory, WhatARunGoesBackBehindHasNotHappened) {
  LiveHistory history;
  history.take(told(1, 2, {0, 50, 0, 100, {{30, 30, 1, "event", "early"}, {120, 120, 1, "event", "late"}}}), step);
  EXPECT_TRUE(history.can_go_back());
  // The question was still about the first run: what it brought is asked for again.
  EXPECT_TRUE(history.take(told(2, 9, {100, 50, 0, 100, {{101, 101, 1, "event", "partly"}}}), step));
  EXPECT_EQ(texts(history.events()), (Texts{"early"}));
  EXPECT_EQ(history.question().revision, 0U);
  EXPECT_TRUE(history.take(told(2, 1, {100, 50, 50, 100, {{101, 101, 1, "event", "anew"}}}), step));
  EXPECT_EQ(texts(history.events()), (Texts{"early", "anew"}));
  EXPECT_EQ(history.first_kept(), std::chrono::milliseconds(500));
  EXPECT_TRUE(history.take(told(3, 0, {}), step));
  EXPECT_TRUE(history.events().events.empty()) << "a reset";
}

TEST(ViewHistory, KeepsTheNewestEventsOnly) {
  LiveHistory history;
  messages::RunHistory all;
  for (std::uint64_t i = 0; i < ViewEvents::most + 10; ++i) all.events.push_back({i, i, 1, "event", std::to_string(i)});
  history.take(told(1, all.events.size(), all), step);
  EXPECT_EQ(history.events().events.size(), ViewEvents::most);
  EXPECT_EQ(history.events().events.front().text, "10");
}

TEST(ViewHistory, WhatIsNoHistoryIsRefused) {
  LiveHistory history;
  wire::Reply reply;
  EXPECT_THROW(history.take(reply, step), messages::CdrError);
  reply.returned = wire::HistoryPart{.data = {0, 1, 0, 0, 7}};
  EXPECT_THROW(history.take(reply, step), messages::CdrError);
}

}  // namespace
}  // namespace cohort::view
