// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/commands/small_experiment.hpp"

// Controllers that end their process: the error names the controller, and the results of the run are kept.
namespace cohort::test {
namespace {

namespace fs = std::filesystem;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

struct End {
  const char* name;
  const char* fault;
  int exit_code;
  std::string message;
};
void PrintTo(const End& end, std::ostream* out) { *out << end.name; }

std::string who(const std::string& controller) { return "the controller '" + controller + "' of r1 (team pair)"; }
const std::string misbehaving = who(test_controller("misbehaving"));

std::string name_of(const ::testing::TestParamInfo<End>& parameter) { return parameter.param.name; }

Ended run_with(const SmallExperiment& experiment, const End& end, std::vector<std::string> arguments) {
  return run_to_end(experiment.run(arguments), {{"COHORT_TEST_FAULT", end.fault}, {"COHORT_TEST_ROBOT", "r1"}});
}

class ExitOfAController : public ::testing::TestWithParam<End> {};

TEST_P(ExitOfAController, EndsTheRunWithANamedErrorAndASummary) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 1.0);
  const std::string summary = (experiment / "summary.json").string();
  const std::string recording = (experiment / "run.mcap").string();
  const Ended run =
      run_with(experiment, GetParam(), {"--controllers", "inprocess", "--summary", summary, "--record", recording});
  EXPECT_EQ(run.exit_code, GetParam().exit_code);
  EXPECT_TRUE(has(run.err, "cohort: error: the run ended at tick ")) << run.err;
  EXPECT_TRUE(has(run.err, GetParam().message)) << run.err;
  EXPECT_TRUE(has(run.out, "state hash")) << run.out;
  ASSERT_TRUE(fs::exists(summary));
  EXPECT_TRUE(has(read_json(summary)["events"].dump(), GetParam().message)) << read_json(summary)["events"];
  const std::string reads =
      read_json(summary)["ticks"] == 0 ? "recover" : "replay";  // a recording without ticks cannot be replayed
  EXPECT_EQ(run_to_end({cohort_program(), reads, recording}).exit_code, 0);
}

INSTANTIATE_TEST_SUITE_P(
    , ExitOfAController,
    ::testing::Values(End{"InStep", "leave", 1, misbehaving + " ended the process in step at tick 20"},
                      End{"InStepQuickly", "leave quickly", 1, misbehaving + " ended the process in step at tick 20"},
                      End{"InStart", "leave in start", 1, misbehaving + " ended the process in start at tick 0"},
                      End{"InItsDestructor", "leave in its destructor", 1,
                          misbehaving + " ended the process in its destructor at tick "}),
    name_of);

class EndOfTheProcess : public ::testing::TestWithParam<End> {};

TEST_P(EndOfTheProcess, NamesTheControllerRobotTeamAndTick) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 1.0);
  const std::string recording = (experiment / "run.mcap").string();
  const Ended run = run_with(experiment, GetParam(), {"--controllers", "inprocess", "--record", recording});
  EXPECT_EQ(run.exit_code, GetParam().exit_code);
  EXPECT_TRUE(has(run.err, "cohort: error: " + GetParam().message)) << run.err;
  const Ended json = run_with(experiment, GetParam(), {"--controllers", "inprocess", "--log-format", "json"});
  EXPECT_TRUE(has(json.err, "\"level\":\"error\",\"message\":\"" + GetParam().message)) << json.err;
}

const std::string segfault = " crashed with signal 11 (Segmentation fault) in step at tick 20";
const std::string aborted = " crashed with signal 6 (Aborted) in step at tick 20";

INSTANTIATE_TEST_SUITE_P(
    , EndOfTheProcess,
    ::testing::Values(End{"Segfault", "segfault", 139, misbehaving + segfault},
                      End{"StackOverflow", "overflow the stack", 139, misbehaving + segfault},
                      End{"Abort", "abort", 134, misbehaving + aborted},
                      End{"Terminate", "terminate", 134, misbehaving + aborted},
                      End{"ExceptionOfAThread", "throw on a thread", 134,
                          "a thread crashed with signal 6 (Aborted) while " + misbehaving + " was in step at tick 20"},
                      End{"ExitOnAThread", "leave on a thread", 1,
                          "a thread ended the process while " + misbehaving + " was in step at tick 20"},
                      End{"ExitOnTrial", "leave on trial", 2, misbehaving + " ended the process in start at tick 0"},
                      End{"CrashOnTrial", "crash on trial", 139,
                          misbehaving + " crashed with signal 11 (Segmentation fault) in start at tick 0"},
                      End{"ExitWhileLoaded", "leave while loaded", 2,
                          "the controller plugin " + test_controller("misbehaving") +
                              " ended the process in its static constructors"}),
    name_of);

TEST(Controllers, CheckNamesAControllerThatExits) {
  const SmallExperiment experiment;
  const Ended check = run_to_end({cohort_program(), "check", experiment.file(), "--load-controllers"},
                                 {{"COHORT_TEST_FAULT", "leave on trial"}, {"COHORT_TEST_ROBOT", "r1"}});
  EXPECT_EQ(check.exit_code, 2);
  EXPECT_TRUE(has(check.err, misbehaving + " ended the process in start at tick 0")) << check.err;
}

TEST(Controllers, HostNamesAControllerThatExits) {
  const SmallExperiment experiment(test_controller("misbehaving"), "    restart: never\n");
  const Ended run = run_to_end(experiment.run(), {{"COHORT_TEST_FAULT", "leave"}, {"COHORT_TEST_ROBOT", "r1"}});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_TRUE(has(run.err, "cohort: error: " + misbehaving + " ended the process in step at tick 20")) << run.err;
  EXPECT_TRUE(has(run.err, " ended with exit code 1; the experiment specifies 'restart: never'")) << run.err;
}

}  // namespace
}  // namespace cohort::test
