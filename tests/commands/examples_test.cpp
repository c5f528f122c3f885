// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include "tests/commands/cohort_command.hpp"
#include "tests/commands/small_experiment.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

TEST(Examples, AreListedWithDescriptions) {
  const Ended listed = cohort({"examples"});
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_NE(listed.out.find("chain                    Four s-bots form a chain and cross a trough"), std::string::npos)
      << listed.out;
}

TEST(Examples, AreRunByName) {
  const ScratchFolder folder;
  const std::string summary = folder / "summary.json";
  const Ended ran = cohort({"run", "obstacle_avoidance", "--duration", "0.5", "--summary", summary});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_TRUE(ran.out.starts_with("experiment        obstacle_avoidance, seed 1 (Cohort ")) << ran.out;
  EXPECT_EQ(hash_in(summary), reference_hash(0.5));
  EXPECT_EQ(read_json(summary)["experiment"], "obstacle_avoidance");
  EXPECT_EQ(read_json(summary)["seed"], 1);
}

TEST(Examples, AreSuggestedForMisspeltNames) {
  const Ended ended = cohort({"run", "obstacle_avoidence"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find("did you mean 'obstacle_avoidance'?"), std::string::npos) << ended.err;
}

TEST(Examples, AreCopiedWithTheirDependencies) {
  const ScratchFolder folder;
  const std::string copy = folder / "worlds";
  EXPECT_EQ(cohort({"examples", "--copy", copy}).exit_code, 0);
  EXPECT_EQ(cohort({"check", copy + "/experiments/retrieval.yaml"}).exit_code, 0);
  const Ended again = cohort({"examples", "--copy", copy});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.err.find("exists and is not an empty folder"), std::string::npos) << again.err;
}

TEST(Examples, TellHowWellContactsAndJointsWereSolved) {
  const ScratchFolder folder;
  const std::string file = folder / "summary.json";
  const Ended ran = cohort({"run", "aggregation", "--duration", "3", "--controllers", "inprocess", "--summary", file});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.err.find("warning"), std::string::npos) << ran.err;
  const nlohmann::json summary = read_json(file);
  const nlohmann::json& convergence = summary["convergence"];
  EXPECT_GT(convergence["groups"], 300) << "one for each step at least";
  EXPECT_LT(convergence["unconverged"], convergence["groups"]);
  const bool is_any = convergence["unconverged"] > 0;
  EXPECT_EQ(convergence["worst"] > 1e-6, is_any);
  EXPECT_EQ(ran.out.find("\nconvergence       ") != std::string::npos, is_any) << ran.out;
  EXPECT_EQ(std::ranges::count(summary["events"], "unconverged", [](const auto& event) { return event["kind"]; }),
            is_any);
}

TEST(Examples, RunWithOtherValuesWhichRecordingsContain) {
  const ScratchFolder folder;
  const std::string recording = folder / "run.mcap";
  const auto hash_of = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "posts", "--duration", "1", "--summary", folder / "summary.json"});
    const Ended ran = cohort(more);
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return hash_in(folder / "summary.json");
  };
  const std::string changed =
      hash_of({"--set", "world.population.posts.count=5", "--set", "teams.learners.period=4", "--record", recording});
  EXPECT_NE(changed, hash_of({}));
  EXPECT_NE(changed, hash_of({"--set", "world.population.posts.count=5"}));
  const Ended replayed = cohort({"replay", recording, "--verify"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  const Ended misspelt = cohort({"check", "posts", "--set", "teams.learner.period=4"});
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_NE(misspelt.err.find("posts.yaml:6: teams.learner.period"), std::string::npos) << misspelt.err;
  EXPECT_NE(misspelt.err.find("did you mean 'learners'?"), std::string::npos) << misspelt.err;
}

TEST(Seeds, ProduceOneRunEach) {
  const ScratchFolder folder;
  const auto run = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "obstacle_avoidance", "--duration", "0.2", "--controllers", "inprocess",
                               "--summary", folder / name});
    const Ended ended = cohort(more);
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
  };
  run("all.json", {"--seeds", "3..4,1"});
  for (const auto& [number, seed] : {std::pair{"1", "3"}, {"2", "4"}, {"3", "1"}}) {
    const std::string one_of_all = folder / ("all-" + std::string(number) + ".json");
    EXPECT_EQ(std::to_string(read_json(one_of_all)["seed"].get<int>()), seed);
    run("alone.json", {"--seed", seed});
    EXPECT_EQ(hash_in(one_of_all), hash_in(folder / "alone.json"));
  }
}

TEST(Seeds, ShowATableThatDoesNotDependOnHowManyRunAtOnce) {
  const ScratchFolder folder;
  const auto hashes = [&](const std::string& jobs, const std::string& controllers) {
    const std::string csv = folder / "table.csv";
    const Ended ended = cohort({"run", "obstacle_avoidance", "--duration", "0.2", "--seeds", "1..3", "--jobs", jobs,
                                "--controllers", controllers, "--csv", csv});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_TRUE(ended.out.starts_with("experiment obstacle_avoidance, 3 runs (Cohort ")) << ended.out;
    EXPECT_EQ(ended.out.find("contacts          "), std::string::npos) << "no summary of a run: " << ended.out;
    std::vector<std::string> shown = lines_of(ended.out);
    EXPECT_EQ(shown.size(), 7u) << ended.out;
    shown.resize(7);
    EXPECT_NE(shown[5].find("mean"), std::string::npos) << ended.out;
    EXPECT_NE(shown[6].find("std"), std::string::npos) << ended.out;
    for (int seed = 1; seed <= 3; ++seed)
      EXPECT_NE(ended.err.find("obstacle_avoidance, seed " + std::to_string(seed) + ": 0.20 s simulated"),
                std::string::npos)
          << ended.err;
    std::vector<std::string> rows = lines_of(read_file(csv));
    EXPECT_EQ(rows.size(), 4u);
    rows.resize(4);
    EXPECT_TRUE(rows[0].starts_with("experiment,seed,ticks,simulated_s,")) << rows[0];
    std::vector<std::string> all;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      EXPECT_TRUE(rows[i].starts_with("obstacle_avoidance," + std::to_string(i) + ",20,0.2,")) << rows[i];
      all.push_back(rows[i].substr(rows[i].rfind(',') + 1));
      EXPECT_NE(shown[i + 1].find(all.back()), std::string::npos) << ended.out;
    }
    return all;
  };
  const std::vector<std::string> one = hashes("1", "inprocess");
  EXPECT_NE(one[0], one[1]);
  EXPECT_EQ(hashes("3", "inprocess"), one);
  EXPECT_EQ(hashes("1", "process"), one);
  EXPECT_EQ(hashes("3", "process"), one);
}

TEST(Seeds, SideBySideAreRefusedWhereARunIsWatchedOrControlled) {
  const Ended ended = cohort({"run", "obstacle_avoidance", "--seeds", "1..2", "--jobs", "2", "--paused"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find("'--jobs 2' cannot be used with '--paused'"), std::string::npos) << ended.err;
  const Ended alone = cohort({"run", "obstacle_avoidance", "--jobs", "2"});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_NE(alone.err.find("'--jobs' needs '--seeds'"), std::string::npos) << alone.err;
}

TEST(Seeds, SideBySideEndWithTheFirstThatFails) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 1.0);
  std::vector<std::string> command = experiment.run({"--seeds", "1..9", "--jobs", "2"});
  const Ended ended = run_to_end(command, {{"COHORT_TEST_FAULT", "throw"}});
  EXPECT_EQ(ended.exit_code, 1) << ended.err;
  EXPECT_NE(ended.err.find(" of 9, seed "), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find(" failed"), std::string::npos) << ended.err;
  EXPECT_EQ(ended.out, "") << "no run has succeeded";
}

TEST(Seeds, SideBySideEndInOrderWhenInterrupted) {
  Process runs({cohort_program(), "run", "obstacle_avoidance", "--duration", "100000", "--controllers", "inprocess",
                "--seeds", "1..9", "--jobs", "2"});
  ASSERT_TRUE(eventually([&] { return children_of(runs.pid()).size() == 2; })) << runs.output();
  const std::vector<pid_t> children = children_of(runs.pid());
  runs.signal(SIGINT);
  EXPECT_EQ(runs.wait_for_exit(), 130) << runs.output();
  for (const pid_t child : children) EXPECT_TRUE(wait_until_gone(child));
}

TEST(Seeds, AreRejectedIfInvalid) {
  for (const auto& [seeds, message] : {std::pair{"4..3", "expected seeds such as 1..30 or 4,8,15, not '4..3'"},
                                       {"a", "not 'a'"},
                                       {"0..18446744073709551615", "expected at most 100000 seeds"}}) {
    const Ended ended = cohort({"run", "obstacle_avoidance", "--seeds", seeds});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_NE(ended.err.find(message), std::string::npos) << ended.err;
  }
}

TEST(Subcommands, AreSuggestedForMisspeltNames) {
  const Ended ended = cohort({"ctl", "sttus"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find("there is no command 'sttus'; did you mean 'status'?"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace cohort::test
