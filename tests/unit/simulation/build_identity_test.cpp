#include "server/simulation/build_identity.hpp"

#include <gtest/gtest.h>

#include <cfenv>

namespace cohort {
namespace {

TEST(BuildIdentity, HasTheSameFingerprintEachTime) {
  EXPECT_EQ(this_build().arithmetic, arithmetic_fingerprint());
  EXPECT_EQ(this_build().arithmetic.size(), 16U);
}

// As other functions or solvers would.
TEST(BuildIdentity, ChangesItsFingerprintWithTheRoundingMode) {
  const std::string usual = arithmetic_fingerprint();
  std::fesetround(FE_DOWNWARD);
  const std::string other = arithmetic_fingerprint();
  std::fesetround(FE_TONEAREST);
  EXPECT_NE(other, usual);
}

TEST(BuildIdentity, WarnsOfOtherResultsForAnotherArithmeticOrVersion) {
  BuildIdentity other = this_build();
  EXPECT_EQ(why_results_differ(other), "");
  other.commit = "0123456789ab";
  EXPECT_EQ(why_results_differ(other), "") << "the arithmetic is the same";
  other.arithmetic = "";
  EXPECT_EQ(why_results_differ(other), "") << "nothing is known";
  other.arithmetic = "0123456789abcdef";
  EXPECT_NE(why_results_differ(other).find("commit 0123456789ab; this is"), std::string::npos);
  EXPECT_TRUE(why_results_differ(other).ends_with("results will differ"));
  other.arithmetic = this_build().arithmetic;
  other.version = "0.0.1";
  EXPECT_TRUE(why_results_differ(other).ends_with("results may differ"));
}

}  // namespace
}  // namespace cohort
