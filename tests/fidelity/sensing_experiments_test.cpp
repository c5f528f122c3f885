// What the experiments of light and sound come to, in numbers, for three seeds each.

#include <gtest/gtest.h>

#include "tests/support/shipped_experiment.hpp"

namespace cohort {
namespace {

using testing::ShippedExperiment;

class Phototaxis : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Experiments, Phototaxis, ::testing::Values(1, 2, 3));

TEST_P(Phototaxis, TwoLampsMakeTwoGroupsOneMakesOneAndNoneNone) {
  constexpr double east = 1.1, west = -1.1, radius = 0.8;
  const auto look = [&](const ShippedExperiment& run) {
    const double time = run.seconds();
    const int at_east = run.robots_near(east, 0.0, radius);
    const int at_west = run.robots_near(west, 0.0, radius);
    if (time == 89.0) {
      EXPECT_EQ(at_east + at_west, 20) << "all are at one of the two";
      EXPECT_GE(std::min(at_east, at_west), 5) << "and both have a group";
    }
    if (time == 209.0) {
      EXPECT_GE(at_west, 18) << "nearly all are at the one that is on";
    }
    if (time == 300.0) {
      EXPECT_LE(at_west, 8) << "they have spread";
      EXPECT_LE(at_east, 8);
    }
  };
  const ShippedExperiment run("phototaxis", GetParam(), 0.0, look);
  EXPECT_EQ(run.seconds(), 300.0);
  EXPECT_FALSE(run.has_quarantined());
}

class Aggregation : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Experiments, Aggregation, ::testing::Values(1, 2, 3));

TEST_P(Aggregation, SmallGroupsBecomeLargeOnes) {
  constexpr double reach = 0.25;
  int at_first = 0;
  int sum = 0, looks = 0;
  const auto look = [&](const ShippedExperiment& run) {
    if (run.seconds() == 0.0) at_first = run.largest_group(reach);
    if (run.seconds() < 300.0 || run.simulation.tick() % 500 != 0) return;
    sum += run.largest_group(reach);
    ++looks;
  };
  const ShippedExperiment run("aggregation", GetParam(), 0.0, look);
  EXPECT_LE(at_first, 4);
  EXPECT_GE(static_cast<double>(sum) / looks, 7.0) << "of 20, over the last 100 s";
}

}  // namespace
}  // namespace cohort
