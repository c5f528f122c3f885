// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

TEST(SameHashAnySpeed, FiveTimesRealTimeAndUnboundedGiveTheSameBits) {
  const std::string expected = reference_hash(5);
  const auto paced = run_demo({"--duration", "5", "--speed", "5"});
  EXPECT_EQ(paced["state_hash"], expected);
  EXPECT_LE(paced["real_time_factor"].get<double>(), 5.1) << "it ran faster than asked";
  const auto unbounded = run_demo({"--duration", "5", "--speed", "max"});
  EXPECT_EQ(unbounded["state_hash"], expected);
}

}  // namespace
}  // namespace cohort::test
