// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/requests/requester_slots.hpp"

#include <gtest/gtest.h>

namespace cohort::session {
namespace {

using namespace std::chrono_literals;

TEST(RequesterSlots, AreLimitedForEachIdentity) {
  RequesterSlots slots;
  std::size_t in = 0;
  for (std::uint64_t client = 1; client <= 70; ++client)
    if (slots.use(client, "red", true, 10s).is_in) ++in;
  EXPECT_EQ(in, RequesterSlots::most_of_identity);
  EXPECT_TRUE(slots.use(1000, "operator", true, 10s).is_in);
}

TEST(RequesterSlots, AreReservedForEachRole) {
  RequesterSlots slots;
  std::size_t in = 0;
  for (std::uint64_t client = 0; client < 300; ++client)
    if (slots.use(client, "observer_" + std::to_string(client % 10), false, 10s).is_in) ++in;
  EXPECT_EQ(in, RequesterSlots::most - RequesterSlots::kept_for_role);
  for (std::uint64_t client = 1000; client < 1000 + RequesterSlots::kept_for_role; ++client)
    EXPECT_TRUE(slots.use(client, "operator", true, 10s).is_in) << client;
  EXPECT_FALSE(slots.use(2000, "operator", true, 10s).is_in) << "all slots are taken, and no client is idle";
}

TEST(RequesterSlots, AreTakenFromTheLongestIdleClientWhenAllAreInUse) {
  RequesterSlots slots;
  for (std::uint64_t client = 0; client < RequesterSlots::most; ++client)
    ASSERT_TRUE(slots.use(client, "", true, 10s + std::chrono::milliseconds(client)).is_in);
  slots.use(0, "", true, 11s);
  EXPECT_FALSE(slots.use(100, "", true, 11s).is_in) << "nobody is idle";
  const auto admission = slots.use(100, "", true, 11600ms);
  EXPECT_TRUE(admission.is_in);
  EXPECT_EQ(admission.leaves, 1u);
  EXPECT_TRUE(slots.use(100, "", true, 11600ms).is_in) << "it stays";
  slots.leave(100);
  const auto after = slots.use(200, "", true, 11600ms);
  EXPECT_TRUE(after.is_in);
  EXPECT_FALSE(after.leaves);
}

TEST(RequesterSlots, AreReusedWithinAnIdentityAtItsLimit) {
  RequesterSlots slots;
  ASSERT_TRUE(slots.use(999, "operator", true, 1s).is_in);
  for (std::uint64_t client = 0; client < RequesterSlots::most_of_identity; ++client)
    ASSERT_TRUE(slots.use(client, "red", true, 10s).is_in);
  const auto admission = slots.use(500, "red", true, 20s);
  EXPECT_TRUE(admission.is_in);
  ASSERT_TRUE(admission.leaves);
  EXPECT_NE(*admission.leaves, 999u) << "which is idle for longer, but another's";
}

}  // namespace
}  // namespace cohort::session
