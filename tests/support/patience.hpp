#pragma once

#include <chrono>

namespace cohort::test {

/// How long a test waits for something that should happen before it fails: long, since it is never waited for in vain,
/// and shorter than ctest waits for the test (COHORT_TEST_TIMEOUT).
inline constexpr std::chrono::seconds patience{COHORT_TEST_PATIENCE};

}  // namespace cohort::test
