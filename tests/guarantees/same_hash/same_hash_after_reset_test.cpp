// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "tests/support/worlds/field_of_robots.hpp"

namespace cohort::test {
namespace {

// Aggregation's controllers have state, so a reset must also reset them.
TEST(SameHashAfterReset, ConsecutiveRunsWithTheSameControllersGiveTheSameBits) {
  const std::string experiment = COHORT_SOURCE_DIR "/worlds/experiments/aggregation.yaml";
  const ScratchFolder folder;
  for (const char* placement : {"process", "per-robot", "inprocess"}) {
    const auto ended = run_to_end({cohort_program(), "run", experiment, "--duration", "3", "--repeat", "3",
                                   "--controllers", placement, "--summary", (folder / "summary.json").string()});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const std::set<std::string> hashes = {hash_in(folder / "summary-1.json"), hash_in(folder / "summary-2.json"),
                                          hash_in(folder / "summary-3.json")};
    EXPECT_EQ(hashes.size(), 1u) << placement << ": " << *hashes.begin() << " " << *hashes.rbegin();
  }
}

TEST(SameHashAfterReset, ASessionOfSeveralExperimentsKeepsItsControllersAndBits) {
  const std::string changes = COHORT_SOURCE_DIR "/worlds/experiments/changes.yaml";
  const auto demo = run_demo({"--controllers", "inprocess", "--duration", "5"});
  const auto changed = run_experiment(changes, {"--controllers", "inprocess", "--duration", "5"});
  const ScratchFolder folder;
  const ReservedDomain domain;
  Process server({cohort_program(), "serve", demo_experiment(), changes, "--repeat", "2", "--duration", "5", "--domain",
                  domain.text(), "--summary", (folder / "summary.json").string()});
  Process controllers({cohort_program(), "host", "obstacle_avoidance", "--robots", "all", "--domain", domain.text()});
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(controllers.wait_for_exit(), 0) << controllers.output();
  for (const char* number : {"1", "3"})
    EXPECT_EQ(hash_in(folder / ("summary-" + std::string(number) + ".json")), demo["state_hash"]) << number;
  for (const char* number : {"2", "4"})
    EXPECT_EQ(hash_in(folder / ("summary-" + std::string(number) + ".json")), changed["state_hash"]) << number;
}

// The next experiment has fewer robots: a client that asks for others must leave, and reports why.
TEST(SameHashAfterReset, AClientWithoutRobotsInTheNextExperimentIsRefusedByName) {
  const FieldOfRobots fewer(15, 1.0);
  const ReservedDomain domain;
  Process server(
      {cohort_program(), "serve", demo_experiment(), fewer.file(), "--duration", "1", "--domain", domain.text()});
  Process first({cohort_program(), "host", "obstacle_avoidance", "--robots", "0..14", "--domain", domain.text()});
  Process last({cohort_program(), "host", "obstacle_avoidance", "--robots", "15", "--domain", domain.text()});
  EXPECT_EQ(last.wait_for_exit(), 2) << last.output();
  EXPECT_NE(last.output().find("refused"), std::string::npos) << last.output();
  EXPECT_EQ(server.wait_for_exit(), 0) << "the others go on: " << server.output();
  EXPECT_EQ(first.wait_for_exit(), 0) << first.output();
}

}  // namespace
}  // namespace cohort::test
