// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/kept_snapshots.hpp"

#include <gtest/gtest.h>

namespace cohort::session {
namespace {

SessionSnapshot of_tick(std::uint64_t tick) {
  return {.experiment = "e", .seed = 1, .tick = tick, .simulation = std::vector<std::byte>(1000), .exchange = {}};
}

void run(KeptSnapshots& kept, std::uint64_t from, std::uint64_t to) {
  for (std::uint64_t tick = from; tick <= to; ++tick)
    if (kept.wants(tick)) kept.keep(of_tick(tick));
}

TEST(KeptSnapshots, ReturnTheLastAtOrBeforeATick) {
  KeptSnapshots kept(10, 1 << 20);
  EXPECT_EQ(kept.last_until(100), nullptr);
  run(kept, 5, 57);
  EXPECT_EQ(kept.size(), 5U);
  EXPECT_EQ(kept.last_until(9), nullptr);
  EXPECT_EQ(kept.last_until(10)->tick, 10U);
  EXPECT_EQ(kept.last_until(49)->tick, 40U);
  EXPECT_EQ(kept.last_until(1000)->tick, 50U);
  kept.forget_after(30);
  EXPECT_EQ(kept.last_until(1000)->tick, 30U);
  EXPECT_TRUE(kept.wants(40)) << "it comes again, and may be another";
  EXPECT_FALSE(kept.wants(30));
}

TEST(KeptSnapshots, BecomeFewerWhenTheyTakeTooMuchMemory) {
  KeptSnapshots kept(1, 20'000);
  run(kept, 0, 10'000);
  EXPECT_LE(kept.size(), 20U);
  EXPECT_GE(kept.size(), 8U);
  EXPECT_EQ(kept.first_tick(), 0U);
  EXPECT_GE(kept.last_tick(), 9'000U);
  for (std::uint64_t tick = 0; tick < 10'000; tick += 100)
    EXPECT_LE(tick - kept.last_until(tick)->tick, 10'000U / 8) << "all of the run can be gone back to";
}

TEST(KeptSnapshots, AreOffByDefault) {
  KeptSnapshots kept(0, 1 << 20);
  run(kept, 0, 100);
  EXPECT_EQ(kept.size(), 0U);
}

}  // namespace
}  // namespace cohort::session
