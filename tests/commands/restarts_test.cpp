// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <csignal>

#include "tests/commands/small_experiment.hpp"
#include "tests/support/control.hpp"
#include "tests/support/worlds/field_of_robots.hpp"

namespace cohort::test {
namespace {

std::size_t times(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

const std::string was_aborted = " was terminated by signal 6 (Aborted)";

TEST(Restarts, KeepTheHashOfTheRun) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 1.0);
  const Ended expected = run_to_end(experiment.run({"--controllers", "inprocess"}));
  const Ended run = run_to_end(
      experiment.run(), {{"COHORT_TEST_FAULT", "abort once"}, {"COHORT_TEST_FILE", (experiment / "aborted").string()}});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(times(run.err, "restarting it"), 1u) << run.err;
  EXPECT_NE(run.err.find("team 'pair' (r0 and 1 more): controller process "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(was_aborted + "; restarting it (1 of 3)"), std::string::npos) << run.err;
  const auto hash = [](const Ended& ended) { return ended.out.substr(ended.out.find("state hash")); };
  EXPECT_EQ(hash(run), hash(expected));
}

TEST(Restarts, EndTheRunAtTheFourthDeath) {
  const SmallExperiment experiment;
  const Ended run = run_to_end(experiment.run(), {{"COHORT_TEST_FAULT", "abort"}});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_EQ(times(run.err, "restarting it"), 3u) << run.err;
  EXPECT_NE(run.err.find("cohort: error: the run ended at tick 20: team 'pair' (r0 and 1 more): controller process "),
            std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find(was_aborted + "; it had been restarted 3 times before\n"), std::string::npos) << run.err;
  EXPECT_NE(run.out.find("state hash"), std::string::npos) << run.out;
}

TEST(Restarts, NeverEndsTheRunAndNamesTeamRobotsAndSignal) {
  const SmallExperiment experiment(test_controller("misbehaving"), "    restart: never\n");
  const Ended run = run_to_end(experiment.run({"--controllers", "per-robot"}),
                               {{"COHORT_TEST_FAULT", "abort"}, {"COHORT_TEST_ROBOT", "r1"}});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_EQ(times(run.err, "restarting it"), 0u) << run.err;
  EXPECT_NE(run.err.find("team 'pair' (r1): controller process "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(was_aborted + "; the experiment specifies 'restart: never'\n"), std::string::npos) << run.err;
  EXPECT_EQ(times(run.err, "cohort: "), 1u) << "nothing else is said\n" << run.err;
}

TEST(Restarts, TreatAnEndWithoutErrorDuringARunAsADeath) {
  const SmallExperiment experiment(test_controller("misbehaving"), "    restart: never\n");
  const Ended run = run_to_end(experiment.run(), {{"COHORT_TEST_FAULT", "leave"}});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_NE(run.err.find(" ended with exit code 1; the experiment specifies 'restart: never'"), std::string::npos)
      << run.err;
}

class Placement : public ::testing::TestWithParam<const char*> {};

TEST_P(Placement, ReportsAnExceptionOnceAndEndsTheRun) {
  const SmallExperiment experiment;
  const Ended run = run_to_end(experiment.run({"--controllers", GetParam()}),
                               {{"COHORT_TEST_FAULT", "throw"}, {"COHORT_TEST_ROBOT", "r1"}});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_EQ(times(run.err, "a fault on purpose"), 1u) << run.err;
  EXPECT_NE(run.err.find(
                "the run ended at tick 20: the controller of robot 'r1' failed in step at tick 20: a fault on purpose"),
            std::string::npos)
      << run.err;
  EXPECT_EQ(times(run.err, "restarting it"), 0u) << run.err;
}

INSTANTIATE_TEST_SUITE_P(, Placement, ::testing::Values("process", "inprocess"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST(Restarts, DoNotApplyToASupersededController) {
  const SmallExperiment experiment;
  const ReservedDomain domain;
  Process run(experiment.run({"--domain", domain.text(), "--verbose"}));
  ASSERT_TRUE(run.wait_for_output("simulated")) << run.output();
  const std::vector<pid_t> own = children_of(run.pid());
  ASSERT_EQ(own.size(), 1u);
  kill(own[0], SIGSTOP);
  Process other(
      {cohort_program(), "host", test_controller("misbehaving"), "--robots", "all", "--domain", domain.text()});
  ASSERT_TRUE(run.wait_for_output("superseded:")) << run.output();
  kill(own[0], SIGCONT);
  EXPECT_TRUE(wait_until_gone(own[0]));
  run.signal(SIGINT);
  EXPECT_EQ(run.wait_for_exit(), 130) << run.output();
  EXPECT_EQ(other.wait_for_exit(), 0) << other.output();
  EXPECT_EQ(times(run.output(), "restarting it"), 0u) << run.output();
}

// DDS gives a killed server up after 5 s.
TEST(AClientOfAServer, ThatWasKilledSaysSoBeforeItGivesUp) {
  const FieldOfRobots field(2, 1e5);
  const ReservedDomain domain;
  Process server(field.serve(domain, {"--speed", "1"}));
  Process client(FieldOfRobots::host(domain, "all"));
  ASSERT_TRUE(server.wait_for_output("simulated")) << server.output();
  server.signal(SIGKILL);
  EXPECT_EQ(client.wait_for_exit(), 1) << client.output();
  const std::string output = client.output();
  const std::size_t silent = output.find("has not responded for 1 s");
  ASSERT_NE(silent, std::string::npos) << output;
  EXPECT_LT(silent, output.find(" is gone")) << output;
}

TEST(AClientOfAServer, ThatWasStoppedSaysWhenItRespondsAgain) {
  const FieldOfRobots field(2, 1e5);
  const ReservedDomain domain;
  Process server(field.serve(domain, {"--paused"}));
  Process client(FieldOfRobots::host(domain, "all"));
  control(domain, {"step", "10"});
  server.signal(SIGSTOP);
  EXPECT_TRUE(client.wait_for_output("has not responded for 1 s")) << client.output();
  server.signal(SIGCONT);
  EXPECT_TRUE(client.wait_for_output("responds again")) << client.output();
}

}  // namespace
}  // namespace cohort::test
