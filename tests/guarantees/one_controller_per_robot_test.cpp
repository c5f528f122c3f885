// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

TEST(OneControllerPerRobot, ASecondClaimIsRefusedByNameOnceTheHolderAnswers) {
  const ReservedDomain domain;
  Process server({cohort_program(), "serve", demo_experiment(), "--duration", "10", "--domain", domain.text()});
  const auto controllers_of = [&](const char* robots) {
    return std::vector<std::string>{cohort_program(), "host",     "obstacle_avoidance", "--robots",
                                    robots,           "--domain", domain.text()};
  };
  Process holder(controllers_of("0..14"));
  ASSERT_TRUE(server.wait_for_output("waiting for explorers/sbot_15")) << server.output();
  Process second(controllers_of("3"));
  ASSERT_TRUE(second.wait_for_output("waiting for the server to admit")) << second.output();
  Process last(controllers_of("15"));  // now the run begins, and the holder answers
  EXPECT_EQ(second.wait_for_exit(), 2) << second.output();
  EXPECT_NE(second.output().find("explorers/sbot_3 is driven by"), std::string::npos) << second.output();
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(holder.wait_for_exit(), 0) << holder.output();
  EXPECT_NE(server.output().find(reference_hash(10)), std::string::npos) << server.output();
}

TEST(OneControllerPerRobot, AClaimOnARobotThatDoesNotExistIsRefusedByName) {
  const ReservedDomain domain;
  Process server({cohort_program(), "serve", demo_experiment(), "--domain", domain.text()});
  Process stranger(
      {cohort_program(), "host", "obstacle_avoidance", "--robots", "explorers/sbot_99", "--domain", domain.text()});
  EXPECT_EQ(stranger.wait_for_exit(), 2) << stranger.output();
  EXPECT_NE(stranger.output().find("explorers/sbot_99"), std::string::npos) << stranger.output();
}

}  // namespace
}  // namespace cohort::test
