// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "idl/text/printable.hpp"
#include "idl/wire/control_messages.hpp"
#include "tests/support/worlds/field_of_robots.hpp"

// Texts of clients are shown to people, but never act as commands to the terminal or end a summary.
namespace cohort::test {
namespace {

constexpr std::uint64_t id_of_stranger = 0x5eed;
const std::string commands =
    "\x1b]0;owned\x07 \xc2\x9b"
    "2J \x7f \xe2\x80\xae";  // C0, C1 in UTF-8, DEL, bidi
const std::string no_utf8 = "\xff\xfe \xc3";

bool is_harmless(const std::string& text) { return printable(text, std::string::npos, Lines::kept) == text; }

wire::Join join_with(const std::string& text, const std::string& robots) {
  wire::Join join;
  join.client = id_of_stranger;
  join.controller = text;
  join.host = text;
  join.robots = {robots};
  return join;
}

class TextsOfStrangers : public ::testing::TestWithParam<std::string> {};

TEST_P(TextsOfStrangers, AreShownHarmlesslyAndTheRunContinues) {
  const FieldOfRobots field(2, 2.0);
  const ReservedDomain domain;
  Process server(field.serve(domain), {{"COHORT_LOG", "info"}});
  wire::Participant participant = wire::Participant::client(domain.number());
  wire::Writer<wire::Join> joins(participant);
  wire::Writer<wire::Request> requests(participant);
  ASSERT_TRUE(eventually([&] { return joins.matched() == 1 && requests.matched() == 1; }));
  wire::Request request{.client = id_of_stranger, .number = 1, .operation = wire::SetSpeed{}};
  request.label = GetParam();
  joins.write(join_with(GetParam(), "no robot " + GetParam()));
  requests.write(request);
  ASSERT_TRUE(server.wait_for_output("SetSpeed")) << server.output();
  Process controllers(FieldOfRobots::host(domain, "all"));
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_TRUE(is_harmless(server.output())) << server.output();
  const auto summary = field.summary();
  EXPECT_FALSE(events_of(summary, "refused").empty()) << summary.dump(1);
  EXPECT_FALSE(events_of(summary, "control").empty()) << summary.dump(1);
  for (const auto& event : summary["events"]) EXPECT_TRUE(is_harmless(event["text"])) << event.dump();
}

TEST_P(TextsOfStrangers, OfAFailingControllerAreShownHarmlessly) {
  const FieldOfRobots field(1, 2.0);
  const ReservedDomain domain;
  Process server(field.serve(domain), {{"COHORT_LOG", "info"}});
  wire::Participant participant = wire::Participant::client(domain.number());
  wire::Writer<wire::Join> joins(participant);
  wire::Writer<wire::Report> reports(participant);
  ASSERT_TRUE(eventually([&] { return joins.matched() == 1 && reports.matched() == 1; }));
  joins.write(join_with("stranger", "all"));
  ASSERT_TRUE(server.wait_for_output("drives")) << server.output();
  reports.write(
      {.client = id_of_stranger, .kind = wire::ReportKind::failed, .reason = "exception", .text = GetParam()});
  EXPECT_EQ(server.wait_for_exit(), 1) << server.output();
  EXPECT_TRUE(is_harmless(server.output())) << server.output();
  const auto summary = field.summary();
  EXPECT_EQ(events_of(summary, "failed").size(), 1u) << summary.dump(1);
}

const std::vector<std::string> names_of_texts = {"AreCommands", "AreNoUtf8", "AreCutInACharacter"};
INSTANTIATE_TEST_SUITE_P(That, TextsOfStrangers,
                         ::testing::Values(commands, no_utf8, std::string(99, 'x') + "\xc3\xa9"),
                         [](const auto& tested) { return names_of_texts.at(tested.index); });

TEST(TextsOfControllers, InTheProcessOfTheServerAreShownHarmlessly) {
  const FieldOfRobots field(1, 1.0, "", test_controller("misbehaving"));
  for (const char* format : {"text", "json"}) {
    const std::string summary = (field / (format + std::string(".json"))).string();
    const Ended ended = run_to_end({cohort_program(), "run", field.file(), "--controllers", "inprocess", "--log-format",
                                    format, "--verbose", "--summary", summary},
                                   {{"COHORT_TEST_FAULT", "throw commands"}});
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_NE(ended.err.find("a fault"), std::string::npos) << ended.err;
    EXPECT_TRUE(is_harmless(ended.err)) << ended.err;
    EXPECT_EQ(events_of(read_json(summary), "failed").size(), 1u);
  }
}

TEST(TextsOfFiles, WithInvalidUtf8OrTerminalControlsInTheirNamesAreShownHarmlessly) {
  const FieldOfRobots field(1, 1.0);
  const std::filesystem::path file = field / ("a\xff\x1b[2J.yaml");
  std::filesystem::copy_file(field.file(), file);
  const std::string summary = (field / "summary.json").string();
  const Ended ended = run_to_end({cohort_program(), "run", file.string(), "--summary", summary, "--verbose"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_TRUE(is_harmless(ended.err)) << ended.err;
  EXPECT_TRUE(is_harmless(ended.out)) << ended.out;
  EXPECT_TRUE(is_harmless(read_json(summary)["experiment"]));
}

}  // namespace
}  // namespace cohort::test
