// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/commands/small_experiment.hpp"

// The output of a run at its end.
namespace cohort::test {
namespace {

TEST(TheSummary, HasTheExchangeWithControllersOnlyWhenVerbose) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 0.1);
  for (const char* controllers : {"inprocess", "process"}) {
    const Ended plain = run_to_end(experiment.run({"--controllers", controllers}));
    EXPECT_NE(plain.out.find("state hash  "), std::string::npos) << plain.err;
    for (const char* line : {"barrier latency", "repeated answers"})
      EXPECT_EQ(plain.out.find(line), std::string::npos) << plain.out;
    const Ended verbose = run_to_end(experiment.run({"--controllers", controllers, "--verbose"}));
    EXPECT_NE(verbose.out.find("barrier latency   p50 "), std::string::npos) << verbose.out;
  }
}

TEST(TheProfile, HasTheTimeOfEachStageAndTheWorkOfTheSolver) {
  const ScratchFolder folder;
  const std::string summary = folder / "summary.json";
  const Ended run = run_to_end({cohort_program(), "run", demo_experiment(), "--duration", "2", "--controllers",
                                "inprocess", "--profile", "--summary", summary});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* line : {"\nprofile  ", "\n  controllers ", "\n  collision detection ", "\n  sensors ", "\nsolver  "})
    EXPECT_NE(run.out.find(line), std::string::npos) << run.out;
  const nlohmann::json written = nlohmann::json::parse(read_file(summary));
  double sum = 0.0;
  for (const auto& [stage, seconds] : written["stages_s"].items()) {
    EXPECT_GT(seconds, 0.0) << stage;
    sum += seconds.get<double>();
  }
  EXPECT_LE(sum, written["wall_s"]);
  EXPECT_GT(sum, 0.2 * written["wall_s"].get<double>()) << "most of the time is in a stage";
  const nlohmann::json& solver = written["convergence"];
  EXPECT_GE(solver["minima"], solver["groups"]);
  EXPECT_GE(solver["steps"], solver["minima"]);
  EXPECT_GE(solver["factorisations"], solver["groups"]);
}

TEST(TheProfile, IsOnlyForThoseWhoAsk) {
  const ScratchFolder folder;
  const std::string summary = folder / "summary.json";
  const Ended run = run_to_end({cohort_program(), "run", demo_experiment(), "--duration", "0.1", "--controllers",
                                "inprocess", "--summary", summary});
  EXPECT_EQ(run.out.find("\nprofile"), std::string::npos) << run.out;
  EXPECT_FALSE(nlohmann::json::parse(read_file(summary)).contains("stages_s"));
}

TEST(TheTableOfSeeds, HasTheCpuTimeOfEachRun) {
  const ScratchFolder folder;
  const std::string table = folder / "table.csv";
  const Ended run = run_to_end({cohort_program(), "run", demo_experiment(), "--duration", "20", "--seeds", "1..4",
                                "--jobs", "1", "--csv", table, "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(read_file(table));
  std::string line;
  std::getline(lines, line);
  ASSERT_TRUE(line.starts_with("experiment,seed,ticks,simulated_s,wall_s,cpu_s,")) << line;
  double last = 0.0;
  double all = 0.0;
  for (int rows = 0; std::getline(lines, line); ++rows) {
    std::istringstream cells(line);
    for (int column = 0; column < 6; ++column) std::getline(cells, line, ',');
    last = std::stod(line);
    all += last;
  }
  EXPECT_LT(last, all / 2) << read_file(table);
}

}  // namespace
}  // namespace cohort::test
