// SPDX-License-Identifier: Apache-2.0
#include "server/serving/inbox.hpp"

#include <gtest/gtest.h>

namespace cohort::session {
namespace {

wire::Sender sender_of(std::uint64_t participant) { return {.writer = 10 * participant, .participant = participant}; }

wire::Request request_of(std::uint64_t number, std::size_t bytes = 0) {
  return {.number = number, .operation = wire::PutData{.data = std::vector<std::uint8_t>(bytes)}};
}

bool add_request(Inbox& inbox, std::uint64_t number, std::uint64_t participant = 1, std::size_t bytes = 0) {
  return inbox.add_request(request_of(number, bytes), sender_of(participant), nullptr);
}

TEST(Inbox, KeepsTheOrderAndIsEmptyOnceTaken) {
  Inbox inbox;
  for (std::uint64_t number = 1; number <= 3; ++number) EXPECT_TRUE(add_request(inbox, number, number));
  for (std::uint32_t process = 5; process > 2; --process) EXPECT_TRUE(inbox.add_ended_process(process));
  EXPECT_TRUE(inbox.add_failure("first"));
  EXPECT_TRUE(inbox.add_failure("second"));
  EXPECT_TRUE(inbox.has_news());
  const Inbox::Contents contents = inbox.take();
  ASSERT_EQ(contents.requests.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(contents.requests[i].request.number, i + 1);
  EXPECT_EQ(contents.ended_processes, (std::vector<std::uint32_t>{5, 4, 3}));
  EXPECT_EQ(contents.failure, "first");
  EXPECT_FALSE(inbox.has_news());
  EXPECT_TRUE(inbox.take().requests.empty());
}

TEST(Inbox, MakesTextsOfClientsPrintable) {
  Inbox inbox;
  wire::Join join;
  join.controller = std::string(99, 'x') + "\u00e9";
  join.host = "\x1b[2J";
  join.robots = {"\xff"};
  inbox.add_arrival(join, sender_of(1), nullptr);
  inbox.add_report({.kind = wire::ReportKind::failed, .text = "one\ntwo\x7f"}, sender_of(1));
  wire::Request request = request_of(1);
  request.label = "\u009b";
  const std::string document = "a document:\n\t\xff";
  request.operation =
      wire::SpawnEntity{.entity = "\x07", .uri = "\x08", .resource_string = document, .team = "a\nteam"};
  inbox.add_request(request, sender_of(1), nullptr);
  const Inbox::Contents contents = inbox.take();
  EXPECT_EQ(contents.arrivals[0].join.controller, std::string(97, 'x') + "\u2026");
  EXPECT_EQ(contents.arrivals[0].join.host, "\ufffd[2J");
  EXPECT_EQ(contents.arrivals[0].join.robots, std::vector<std::string>{"\ufffd"});
  EXPECT_EQ(contents.reports[0].text, "one two\ufffd");
  EXPECT_EQ(contents.requests[0].request.label, "\ufffd");
  const auto& spawn = std::get<wire::SpawnEntity>(contents.requests[0].request.operation);
  EXPECT_EQ(spawn.entity, "\ufffd");
  EXPECT_EQ(spawn.uri, "\ufffd");
  EXPECT_EQ(spawn.team, "a team");
  EXPECT_EQ(spawn.resource_string, document) << "which its parser checks";
}

TEST(Inbox, BoundsJoinsAndReportsInBytes) {
  Inbox inbox;
  wire::Join join;
  join.robots = {std::string(Inbox::largest_join, 'x')};
  EXPECT_FALSE(inbox.add_arrival(join, sender_of(1), nullptr)) << "with the rest of it, it is larger";
  join.robots = {std::string(Inbox::largest_join / 2, 'x')};
  std::size_t taken = 0;
  for (std::size_t i = 0; i < Inbox::most_arrivals; ++i)
    if (inbox.add_arrival(join, sender_of(2), nullptr)) ++taken;
  EXPECT_GT(taken, 2 * Inbox::most_arrival_bytes / Inbox::largest_join - 10) << "the rest of each counts too";
  EXPECT_LE(taken, 2 * Inbox::most_arrival_bytes / Inbox::largest_join);

  wire::Report report;
  report.text.assign(Inbox::largest_report, 'x');
  EXPECT_FALSE(inbox.add_report(report, sender_of(1)));
  report.text.resize(Inbox::largest_report / 2);
  taken = 0;
  for (std::size_t i = 0; i < Inbox::most_reports; ++i)
    if (inbox.add_report(report, sender_of(2))) ++taken;
  EXPECT_GT(taken, 2 * Inbox::most_report_bytes / Inbox::largest_report - 10) << "the rest of each counts too";
  EXPECT_LE(taken, 2 * Inbox::most_report_bytes / Inbox::largest_report);

  const Inbox::Contents contents = inbox.take();
  EXPECT_EQ(contents.rejected.at({1, "malformed"}).count, 2u);
  EXPECT_GT(contents.rejected.at({2, "flood"}).count, 1u);
  EXPECT_TRUE(inbox.add_arrival(join, sender_of(2), nullptr)) << "there is room again";
  EXPECT_TRUE(inbox.add_report(report, sender_of(2)));
}

TEST(Inbox, BoundsRequestsOfOneParticipant) {
  Inbox inbox;
  for (std::uint64_t number = 1; number <= wire::requests_under_way; ++number) EXPECT_TRUE(add_request(inbox, number));
  EXPECT_FALSE(add_request(inbox, wire::requests_under_way + 1));
  EXPECT_TRUE(add_request(inbox, 1, 2)) << "another has room of its own";
  EXPECT_EQ(inbox.take().rejected.at({1, "flood"}).count, 1u);
  EXPECT_TRUE(add_request(inbox, 1)) << "there is room again";
}

TEST(Inbox, BoundsAllRequestsInNumberAndInBytes) {
  Inbox inbox;
  std::uint64_t taken = 0;
  for (std::uint64_t participant = 1; participant <= 2 * Inbox::most_requests; ++participant)
    if (add_request(inbox, 1, participant)) ++taken;
  EXPECT_EQ(taken, Inbox::most_requests);
  inbox.take();

  EXPECT_FALSE(add_request(inbox, 1, 1, Inbox::largest_request)) << "with the rest of it, it is larger";
  constexpr std::size_t large = Inbox::largest_request / 2;
  taken = 0;
  for (std::uint64_t participant = 1; participant <= 64; ++participant)
    if (add_request(inbox, 1, participant, large)) ++taken;
  EXPECT_EQ(taken, Inbox::most_request_bytes / large - 1) << "of which each is a little more than its data";
}

TEST(Inbox, BoundsJoinsReportsAndForeignVersions) {
  Inbox inbox;
  for (std::size_t i = 0; i < Inbox::most_arrivals; ++i) EXPECT_TRUE(inbox.add_arrival({}, sender_of(1), nullptr));
  EXPECT_FALSE(inbox.add_arrival({}, sender_of(2), nullptr));
  for (std::size_t i = 0; i < Inbox::most_reports; ++i) EXPECT_TRUE(inbox.add_report({}, sender_of(1)));
  EXPECT_FALSE(inbox.add_report({}, sender_of(2)));
  for (std::uint32_t major = 2; major < 2 + Inbox::most_foreign_versions; ++major)
    EXPECT_TRUE(inbox.add_foreign_version(major));
  EXPECT_FALSE(inbox.add_foreign_version(2)) << "known already";
  EXPECT_FALSE(inbox.add_foreign_version(1000));
  EXPECT_EQ(inbox.take().rejected.at({2, "flood"}).count, 2u);
}

TEST(Inbox, CountsRejectionsWithoutWakingTheRun) {
  Inbox inbox;
  inbox.reject(7, "stale", "the first");
  inbox.reject(7, "stale", "the second");
  inbox.reject(8, "stale", "of another");
  EXPECT_FALSE(inbox.has_news());
  const Inbox::Rejected rejected = inbox.take().rejected;
  ASSERT_EQ(rejected.size(), 2u);
  EXPECT_EQ(rejected.at({7, "stale"}).count, 2u);
  EXPECT_EQ(rejected.at({7, "stale"}).text, "the first");
}

TEST(Inbox, LivelinessCanBeTakenSeparately) {
  Inbox inbox;
  inbox.add_liveliness(sender_of(1), false);
  inbox.add_ended_process(1);
  EXPECT_TRUE(inbox.has_liveliness());
  EXPECT_EQ(inbox.take_liveliness().size(), 1u);
  EXPECT_FALSE(inbox.has_liveliness());
  EXPECT_EQ(inbox.take().ended_processes.size(), 1u);
}

TEST(Inbox, KeepsTheLastStateOfEachClientAndKindWithinItsBounds) {
  Inbox inbox;
  const std::vector<std::uint8_t> part(wire::largest_state_part), more(wire::largest_state_part + 1);
  wire::ControllerState state{.client = 1, .kind = wire::StateKind::here, .data = part};
  for (state.offset = 0; state.offset < 3; ++state.offset) EXPECT_TRUE(inbox.add_state(state, sender_of(1)));
  state.data = more;
  EXPECT_FALSE(inbox.add_state(state, sender_of(1)));
  state.data = {};
  state.kind = static_cast<wire::StateKind>(7);
  EXPECT_FALSE(inbox.add_state(state, sender_of(1))) << "of a later version";
  state.kind = wire::StateKind::here;
  state.data = part;
  std::size_t taken = 0;
  for (state.client = 2; state.client < 1000; ++state.client)
    if (inbox.add_state(state, sender_of(2))) ++taken;
  EXPECT_LE(taken, Inbox::most_state_bytes / wire::largest_state_part);
  const Inbox::Contents contents = inbox.take();
  EXPECT_EQ(contents.states.at({1, wire::StateKind::here}).head.offset, 2u);
  EXPECT_EQ(contents.rejected.at({1, "malformed"}).count, 1u);
  EXPECT_GT(contents.rejected.at({2, "flood"}).count, 0u);
}

}  // namespace
}  // namespace cohort::session
