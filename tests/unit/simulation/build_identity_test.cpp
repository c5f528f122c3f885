// SPDX-License-Identifier: Apache-2.0
#include "server/simulation/build_identity.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cstring>

#include "server/core/random.hpp"
#include "server/core/snapshot.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/simulation/simulation.hpp"

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

TEST(BuildIdentity, NamesVersionsWhoseSnapshotsAreRestored) {
  const auto versions = versions_of_snapshots();
  EXPECT_EQ(versions.back(), this_build().version);
  EXPECT_NE(std::ranges::find(versions, "0.1.0"), versions.end());
  const auto experiment = parsing::read_experiment(COHORT_SOURCE_DIR "/worlds/experiments/obstacle_avoidance.yaml");
  Simulation simulation(experiment, 1);
  const std::vector<std::byte> own = simulation.save();
  const auto from = [&](std::string_view version) {
    std::vector<std::byte> bytes = own;
    const std::uint64_t name = hash_name(version);
    std::memcpy(bytes.data() + sizeof(std::uint64_t), &name, sizeof name);
    return bytes;
  };
  ASSERT_EQ(from(this_build().version), own);
  const std::uint64_t hash = simulation.state_hash();
  for (const std::string_view version : versions) {
    simulation.step();
    simulation.restore(from(version));
    EXPECT_EQ(simulation.state_hash(), hash) << version;
  }
  EXPECT_THROW(simulation.restore(from("99.0.0")), SnapshotError);
}

}  // namespace
}  // namespace cohort
