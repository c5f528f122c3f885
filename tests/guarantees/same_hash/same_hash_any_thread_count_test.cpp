// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

TEST(SameHashAnyThreadCount, OneTwoFourAndEightThreadsGiveTheSameBits) {
  const std::string expected = reference_hash(10);
  for (const char* threads : {"1", "2", "4", "8"}) {
    const auto summary = run_demo({"--controllers", "inprocess", "--duration", "10", "--threads", threads});
    EXPECT_EQ(summary["state_hash"], expected) << threads << " threads";
    EXPECT_EQ(summary["ticks"], 1000);
  }
}

TEST(SameHashAnyThreadCount, AnotherSeedGivesOtherBits) {
  const auto summary = run_demo({"--controllers", "inprocess", "--duration", "10", "--seed", "987654321"});
  EXPECT_NE(summary["state_hash"], reference_hash(10));
}

}  // namespace
}  // namespace cohort::test
