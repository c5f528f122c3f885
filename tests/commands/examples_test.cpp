#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

Ended cohort(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), cohort_program());
  return run_to_end(arguments);
}

TEST(Examples, AreListedWithWhatTheyShow) {
  const Ended listed = cohort({"examples"});
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_NE(listed.out.find("chain                    Four s-bots make a chain and cross a trough"), std::string::npos)
      << listed.out;
}

TEST(Examples, AreRunByTheirNames) {
  const ScratchFolder folder;
  const std::string summary = folder / "summary.json";
  const Ended ran = cohort({"run", "obstacle_avoidance", "--duration", "0.5", "--summary", summary});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_TRUE(ran.out.starts_with("experiment        obstacle_avoidance, seed 1 (Cohort ")) << ran.out;
  EXPECT_EQ(hash_in(summary), reference_hash(0.5));
  EXPECT_EQ(read_json(summary)["experiment"], "obstacle_avoidance");
  EXPECT_EQ(read_json(summary)["seed"], 1);
}

TEST(Examples, ThatAreMisspeltAreSuggested) {
  const Ended ended = cohort({"run", "obstacle_avoidence"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find("did you mean 'obstacle_avoidance'?"), std::string::npos) << ended.err;
}

TEST(Examples, AreCopiedWithAllThatTheyNeed) {
  const ScratchFolder folder;
  const std::string copy = folder / "worlds";
  EXPECT_EQ(cohort({"examples", "--copy", copy}).exit_code, 0);
  EXPECT_EQ(cohort({"check", copy + "/experiments/retrieval.yaml"}).exit_code, 0);
  const Ended again = cohort({"examples", "--copy", copy});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.err.find("is there already"), std::string::npos) << again.err;
}

TEST(Seeds, HaveARunEach) {
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

TEST(Seeds, ThatAreNoneAreRefused) {
  for (const auto& [seeds, message] : {std::pair{"4..3", "expected seeds such as 1..30 or 4,8,15, not '4..3'"},
                                       {"a", "not 'a'"},
                                       {"0..18446744073709551615", "expected at most 100000 seeds"}}) {
    const Ended ended = cohort({"run", "obstacle_avoidance", "--seeds", seeds});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_NE(ended.err.find(message), std::string::npos) << ended.err;
  }
}

TEST(Commands, InCommandsAreSuggested) {
  const Ended ended = cohort({"ctl", "sttus"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find("there is no command 'sttus'; did you mean 'status'?"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace cohort::test
