// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "tests/commands/small_experiment.hpp"

namespace cohort::test {
namespace {

using nlohmann::json;

// Returns the objects of a log; fails if a line is not an object.
std::vector<json> parsed(const std::string& log) {
  const std::regex iso_8601(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z)");
  std::vector<json> objects;
  for (const std::string& line : lines_of(log)) {
    objects.push_back(json::parse(line, nullptr, false));
    const json& object = objects.back();
    EXPECT_TRUE(object.is_object()) << line;
    if (!object.is_object()) continue;
    EXPECT_TRUE(std::regex_match(object.value("time", ""), iso_8601)) << line;
    const std::string level = object.value("level", "");
    EXPECT_TRUE(level == "debug" || level == "info" || level == "warning" || level == "error") << line;
    EXPECT_TRUE(object.contains("message")) << line;
  }
  return objects;
}

const json* with_message(const std::vector<json>& log, const std::string& part) {
  const auto found = std::find_if(log.begin(), log.end(), [&](const json& object) {
    return object.value("message", "").find(part) != std::string::npos;
  });
  return found == log.end() ? nullptr : &*found;
}

TEST(Logs, JsonLinesAreObjectsWithTimeLevelMessageAndFields) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 1.0);
  const Ended run = run_to_end(experiment.run({"--log-format", "json", "--controllers", "per-robot"}),
                               {{"COHORT_LOG", "debug"}, {"COHORT_TEST_FAULT", "print"}, {"COHORT_TEST_ROBOT", "r1"}});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("state hash"), std::string::npos) << "the summary is for people";
  const std::vector<json> log = parsed(run.err);

  const json* const read = with_message(log, "read " + experiment.file());
  ASSERT_NE(read, nullptr) << run.err;
  EXPECT_EQ((*read)["robots"], 2);
  const json* const started = with_message(log, "started controller process");
  ASSERT_NE(started, nullptr) << run.err;
  EXPECT_EQ((*started)["command"][1], "host");
  const json* const joined = with_message(log, "joined");
  ASSERT_NE(joined, nullptr) << run.err;
  EXPECT_EQ((*joined)["kind"], "joined");
  EXPECT_EQ((*joined)["tick"], 0);
  const json* const finished = with_message(log, "the run has finished");
  ASSERT_NE(finished, nullptr) << run.err;
  EXPECT_NE(run.out.find(finished->value("state_hash", "?")), std::string::npos) << run.out;
  EXPECT_TRUE(
      std::any_of(log.begin(), log.end(), [](const json& object) { return object.value("duration_s", 0.0) == 1.0; }))
      << "progress\n"
      << run.err;

  const json* const printed = with_message(log, "a line of a controller");
  ASSERT_NE(printed, nullptr) << run.err;
  EXPECT_EQ((*printed)["controller_of"], "team 'pair' (r1)");
  EXPECT_NE(with_message(log, "\"quoted\""), nullptr) << run.err;
  EXPECT_NE(with_message(log, "a line on standard output"), nullptr) << run.err;
  EXPECT_EQ(run.out.find("a line on standard output"), std::string::npos) << "scripts read it: " << run.out;
}

TEST(Logs, JsonReportsTheDeathOfAController) {
  const SmallExperiment experiment(test_controller("misbehaving"), "    restart: never\n");
  const Ended run = run_to_end(experiment.run(), {{"COHORT_LOG_FORMAT", "json"}, {"COHORT_TEST_FAULT", "terminate"}});
  EXPECT_EQ(run.exit_code, 1);
  const std::vector<json> log = parsed(run.err);
  EXPECT_NE(with_message(log, "terminate called"), nullptr) << run.err;
  ASSERT_FALSE(log.empty());
  EXPECT_EQ(log.back()["level"], "error");
  EXPECT_EQ(log.back()["tick"], 20);
}

TEST(Logs, JsonProblemsHaveFileLineAndElement) {
  const SmallExperiment experiment("nothing_like_it", "    restrt: never\n");
  write_file(experiment / "world.sdf", std::regex_replace(SmallExperiment::world(), std::regex("<mass>2"), "<mass>0"));
  const Ended run = run_to_end(experiment.run({"--log-format=json"}));
  EXPECT_EQ(run.exit_code, 2);
  const std::vector<json> log = parsed(run.err);
  ASSERT_EQ(log.size(), 2u) << run.err;
  EXPECT_EQ(log[0]["file"], (experiment / "world.sdf").string());
  EXPECT_EQ(log[0]["element"], "world/model[r0]/link[hull]/inertial/mass");
  EXPECT_EQ(log[0]["line"], 7);
  EXPECT_EQ(log[1]["file"], experiment.file());
  EXPECT_EQ(log[1]["element"], "teams[0].restrt");
  EXPECT_EQ(log[1]["line"], 7);
}

TEST(Logs, JsonReportsErrorsOfCommandLinesAndHosts) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"run", "--log-format", "json", "--thrads", "3"},
        {"--log-format", "json"},
        {"host", "nothing_like_it", "--robots", "all", "--log-format=json"},
        {"--log-format", "json", "check", "/nowhere.sdf"}}) {
    std::vector<std::string> command = {cohort_program()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Ended ended = run_to_end(command);
    EXPECT_EQ(ended.exit_code, 2);
    const std::vector<json> log = parsed(ended.err);
    ASSERT_EQ(log.size(), 1u) << ended.err;
    EXPECT_EQ(log[0]["level"], "error");
  }
}

TEST(Logs, ContainOnlyProgressByDefault) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 0.5);
  const Ended run = run_to_end(experiment.run());
  EXPECT_EQ(run.exit_code, 0);
  for (const std::string& line : lines_of(run.err))
    EXPECT_TRUE(line.find("real time") != line.npos || line.starts_with("waiting for")) << line;
}

TEST(Logs, QuietPrintsNothingForASuccessfulRun) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 0.5);
  const Ended run = run_to_end(experiment.run({"--quiet"}), {{"COHORT_LOG", "debug"}});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err, "");
}

TEST(Logs, VerboseIsAcceptedBeforeAndAfterTheCommand) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 0.5);
  for (const bool before : {false, true}) {
    std::vector<std::string> command = experiment.run();
    command.insert(before ? command.begin() + 1 : command.end(), "--verbose");
    const Ended run = run_to_end(command);
    EXPECT_EQ(run.exit_code, 0);
    for (const char* part :
         {"cohort: info: read ", ": 2 models, 2 robots, 1 team, in ", "built the world for ",
          "serving 2 robots on 127.0.0.1, domain ", "started controller process ", "tick 0: joined: "})
      EXPECT_NE(run.err.find(part), std::string::npos) << part << "\n" << run.err;
  }
}

TEST(Logs, OffPrintsOnlyTheSummary) {
  const SmallExperiment experiment(test_controller("misbehaving"), "    restart: never\n");
  const Ended run = run_to_end(experiment.run(), {{"COHORT_LOG", "off"}, {"COHORT_TEST_FAULT", "throw"}});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err, "");
  EXPECT_NE(run.out.find("state hash"), std::string::npos);
}

TEST(Logs, ContainTheWarningsOfAWorldWithTheirPlaces) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 0.1);
  const std::filesystem::path world = experiment / "world.sdf";
  write_file(world, std::regex_replace(SmallExperiment::world(), std::regex("<model name=\"r0\">"),
                                       "$&\n<gripper name=\"g\"/>"));
  for (const char* command : {"run", "check"}) {
    const Ended ended = run_to_end({cohort_program(), command, experiment.file()});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_NE(ended.err.find(world.string() + ":5: warning: world/model[r0]/gripper[g]: "), std::string::npos)
        << ended.err;
  }
}

}  // namespace
}  // namespace cohort::test
