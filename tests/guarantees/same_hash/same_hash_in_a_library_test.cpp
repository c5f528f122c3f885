// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/guarantees/same_hash/names_of_experiments.hpp"
#include "tests/support/process.hpp"

// A program that loads Cohort as a library already has sin, cos … of the C library. Calls of Bullet, and our own, must
// not use these.
namespace cohort::test {
namespace {

std::string hash_from(std::vector<std::string> command) {
  const Ended ended = run_to_end(command);
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  return ended.out;
}

class SameHashInALibrary : public testing::TestWithParam<std::string> {};

TEST_P(SameHashInALibrary, OfEveryShippedExperiment) {
  const std::string experiment = COHORT_SOURCE_DIR "/worlds/experiments/" + GetParam() + ".yaml";
  const std::string program = hash_from({COHORT_BUILD_DIR "/bin/step_world", experiment, "0", "100"});
  const std::string library = hash_from(
      {COHORT_BUILD_DIR "/bin/load_library", COHORT_BUILD_DIR "/lib/libstep_in_library.so", experiment, "100"});
  EXPECT_EQ(library, program);
  EXPECT_EQ(program.size(), 17u);
}

INSTANTIATE_TEST_SUITE_P(Experiments, SameHashInALibrary, testing::ValuesIn(names_of_experiments()),
                         [](const auto& name) { return name.param; });

// Otherwise the test above would pass with any binding.
TEST(SameHashInALibraryThatIsNotBound, CallsGoToTheCLibrary) {
  hash_from({COHORT_BUILD_DIR "/bin/load_library", COHORT_BUILD_DIR "/lib/libstep_in_library.so",
             COHORT_SOURCE_DIR "/worlds/experiments/obstacle_avoidance.yaml", "1", "unbound"});
}

}  // namespace
}  // namespace cohort::test
