// SPDX-License-Identifier: Apache-2.0

// Ids of different kinds are different types, so that what is mixed up does not compile.

#include "server/core/ids.hpp"

#include <gtest/gtest.h>

#include <concepts>
#include <cstdint>
#include <type_traits>

namespace cohort {
namespace {

TEST(Ids, TakeNoMoreSpaceThanTheirNumber) {
  static_assert(sizeof(BodyId) == sizeof(std::uint32_t));
  static_assert(std::is_trivially_copyable_v<BodyId>);
  EXPECT_LT(LinkId{1}, LinkId{2});
  EXPECT_EQ(LinkId{std::size_t{7}}.value, 7u);
}

TEST(Ids, DoNotConvertToOtherKindsOrNumbers) {
  static_assert(!std::convertible_to<JointId, LinkId>);
  static_assert(!std::constructible_from<LinkId, JointId>);
  static_assert(!std::equality_comparable_with<JointId, LinkId>);
  static_assert(!std::convertible_to<std::uint32_t, BodyId>);
  static_assert(!std::convertible_to<BodyId, std::uint32_t>);
  static_assert(std::constructible_from<BodyId, std::size_t>);
}

}  // namespace
}  // namespace cohort
