// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/entity_filter.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <stdexcept>

namespace cohort::session {
namespace {

bool matches(const std::string& pattern, const std::string& name) { return EntityFilter(pattern).matches(name); }

TEST(EntityFilter, MatchesPartsOfNamesAsPosixExtendedExpression) {
  EXPECT_TRUE(matches("", "swarm/sbot_1"));
  EXPECT_TRUE(matches("sbot", "swarm/sbot_1"));
  EXPECT_FALSE(matches("^sbot", "swarm/sbot_1"));
  EXPECT_TRUE(matches("^swarm/sbot_[0-9]+$", "swarm/sbot_12"));
  EXPECT_TRUE(matches("_(1|2)$", "swarm/sbot_2"));
  EXPECT_FALSE(matches("_(1|2)$", "swarm/sbot_12"));
  EXPECT_TRUE(matches("[[:digit:]]{2}", "swarm/sbot_12"));
  EXPECT_TRUE(matches("m.s", "swarm/sbot"));
  EXPECT_FALSE(matches("m\\.s", "swarm/sbot"));
  EXPECT_TRUE(matches("\\bsbot_\\d+\\b", "swarm/sbot_1"));
  EXPECT_TRUE(matches("^one$", "one"));
  EXPECT_FALSE(matches("^one$", "one\ntwo")) << "the ends are those of the name, not of a line";
  EXPECT_TRUE(matches("zoë", "zoë/1"));
}

TEST(EntityFilter, ReportsWhyAnExpressionIsInvalid) {
  for (const char* pattern : {"((a*)*", "[", "a{1,30000}", "(a)\\1", "*a", "a\\"}) {
    try {
      const EntityFilter filter(pattern);
      ADD_FAILURE() << pattern;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(std::string("'") + pattern + "' is not a regular expression: "),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_THROW(EntityFilter(std::string(201, 'a')), std::invalid_argument);
}

// Each level of these made the C library's compiler copy what is below: 67 characters took 3.5 GB.
TEST(EntityFilter, TakesLittleMemoryForAnyExpression) {
  const auto peak_in_megabytes = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
  };
  const std::string names(10'000, 'a');
  const long before = peak_in_megabytes();
  for (const std::string repetition : {"+", "*", "?", "{2}", "{1,9}", "+)*("})
    for (const int levels : {10, 20, 60}) {
      std::string pattern(static_cast<std::size_t>(levels), '(');
      pattern += "a";
      for (int level = 0; level < levels; ++level) pattern += ")" + repetition;
      try {
        EntityFilter(pattern).matches(names + "b");
      } catch (const std::invalid_argument&) {
        // Too large, which it says.
      }
    }
  EXPECT_LT(peak_in_megabytes() - before, 64);
}

}  // namespace
}  // namespace cohort::session
