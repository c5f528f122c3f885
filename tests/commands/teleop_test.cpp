// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

const std::string up = "\033[A";

// Two seconds among obstacles; `driver` is the controller of the first robot.
std::string write_experiment(const ScratchFolder& folder, const std::string& driver) {
  const std::filesystem::path file = folder / "experiment.yaml";
  std::ofstream(file) << "world: " COHORT_SOURCE_DIR "/worlds/arenas/obstacles.sdf\nduration: 2\nteams:\n"
                      << "  - name: driver\n    robots: 0\n    " << driver
                      << "  - {name: others, robots: 1..15, controller: obstacle_avoidance}\n";
  return file;
}

// Keys that a person has typed before the run begins.
std::vector<std::string> teleop(const ScratchFolder& folder, const std::string& keys, const ReservedDomain& domain) {
  const std::filesystem::path file = folder / "keys";
  std::ofstream(file) << keys;
  return {"/bin/bash", "-c",
          "exec " + cohort_program() + " teleop --robots 0 --domain " + domain.text() + " < " + file.string()};
}

TEST(Teleop, TurnsKeysIntoCommandsOfTheRobot) {
  const ScratchFolder constant;
  const std::string expected_summary = constant / "summary.json";
  Process expected({cohort_program(), "run",
                    write_experiment(constant,
                                     "controller: constant\n    parameters: {treel/left/velocity: 0.1, "
                                     "treel/right/velocity: 0.05}\n"),
                    "--controllers", "inprocess", "--summary", expected_summary});
  ASSERT_EQ(expected.wait_for_exit(), 0) << expected.output();

  const ScratchFolder folder;
  const ReservedDomain domain;
  const std::string summary = folder / "summary.json";
  Process run({cohort_program(), "run",
               write_experiment(folder,
                                "controller: keyboard\n    parameters:\n      up: {treel/left/velocity: 0.1, "
                                "treel/right/velocity: 0.05}\n"),
               "--speed", "max", "--domain", domain.text(), "--summary", summary});
  ASSERT_TRUE(run.wait_for_output("cohort teleop --robots 0 --domain " + domain.text())) << run.output();
  Process person(teleop(folder, up, domain));
  EXPECT_EQ(run.wait_for_exit(), 0) << run.output();
  EXPECT_EQ(person.wait_for_exit(), 0) << person.output();
  EXPECT_EQ(hash_in(summary), hash_in(expected_summary));
  EXPECT_NE(person.output().find("treel/left/velocity = 0.1"), std::string::npos) << person.output();
}

TEST(Teleop, QuitsCleanlyOnRequest) {
  const ScratchFolder folder;
  const ReservedDomain domain;
  Process person(teleop(folder, up + "q", domain));
  EXPECT_EQ(person.wait_for_exit(), 0);
  EXPECT_EQ(person.output(), "");
}

TEST(Teleop, RequiresDds) {
  const ScratchFolder folder;
  Process run(
      {cohort_program(), "run", write_experiment(folder, "controller: keyboard\n"), "--controllers", "inprocess"});
  EXPECT_EQ(run.wait_for_exit(), 2);
  EXPECT_NE(run.output().find("experiment.yaml:6: "), std::string::npos) << run.output();
}

TEST(Parameters, AreCheckedBeforeTheRunWithTheirLines) {
  const ScratchFolder folder;
  const std::string experiment = write_experiment(
      folder,
      "controller: constant\n    parameters:\n      treel/left/velocity: 0.1\n      treel/right/velocty: 0.1\n");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"run", experiment}, {"check", "--load-controllers", experiment}}) {
    std::vector<std::string> line = {cohort_program()};
    line.insert(line.end(), command.begin(), command.end());
    Process run(line);
    EXPECT_EQ(run.wait_for_exit(), 2);
    EXPECT_NE(run.output().find("experiment.yaml:9: teams[0].parameters: "), std::string::npos) << run.output();
    EXPECT_NE(run.output().find("nearest are treel/right/velocity"), std::string::npos) << run.output();
  }
}

}  // namespace
}  // namespace cohort::test
