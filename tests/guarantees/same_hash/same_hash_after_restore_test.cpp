// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

const std::string experiment = COHORT_SOURCE_DIR "/worlds/experiments/obstacle_avoidance.yaml";

std::string step_world(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {COHORT_BUILD_DIR "/bin/step_world", experiment});
  Process process(arguments);
  EXPECT_EQ(process.wait_for_exit(), 0) << process.output();
  return process.output();
}

class SameHashAfterRestore : public ::testing::Test {
 protected:
  ScratchFolder folder_;
  const std::string file_ = (folder_ / "snapshot").string();
};

TEST_F(SameHashAfterRestore, SavedInOneProcessAndRestoredInAnother) {
  const std::string straight = step_world({"0", "900"});
  const std::string at_400 = step_world({"0", "400", "--save", file_});
  EXPECT_EQ(step_world({"400", "400", "--load", file_}), at_400);
  EXPECT_EQ(step_world({"400", "900", "--load", file_}), straight);
  EXPECT_EQ(step_world({"400", "900", "--load", file_, "--threads", "2"}), straight);
}

TEST_F(SameHashAfterRestore, WithObjectsSpawnedFromTextAndActiveForces) {
  const std::string straight = step_world({"0", "900", "--act", "300"});
  EXPECT_NE(straight, step_world({"0", "900"}));
  const std::string at_400 = step_world({"0", "400", "--act", "300", "--save", file_});
  EXPECT_EQ(step_world({"400", "400", "--load", file_}), at_400);
  EXPECT_EQ(step_world({"400", "900", "--load", file_, "--threads", "4"}), straight);
}

TEST_F(SameHashAfterRestore, SavingAgainGivesTheSameSnapshot) {
  step_world({"0", "300", "--save", file_});
  step_world({"300", "300", "--load", file_, "--save", file_ + "_again"});
  EXPECT_GT(read_file(file_).size(), 1000u);
  EXPECT_TRUE(read_file(file_) == read_file(file_ + "_again"));
}

}  // namespace
}  // namespace cohort::test
