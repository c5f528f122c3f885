// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <thread>

namespace cohort::test {

/// Time that a test waits for an expected event before it fails. It is long, since only a failing test waits for all of
/// it. It is shorter than ctest's time limit of the test (COHORT_TEST_TIMEOUT).
inline constexpr std::chrono::seconds patience{COHORT_TEST_PATIENCE};

/// The same time, for commands with a time limit.
inline const std::string patience_in_seconds = std::to_string(patience.count());

/// Polls until `condition` holds. Returns false if it does not within `at_most`.
template <class Condition>
bool eventually(Condition&& condition, std::chrono::milliseconds at_most = patience,
                std::chrono::milliseconds pause = std::chrono::milliseconds(1)) {
  const auto deadline = std::chrono::steady_clock::now() + at_most;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(pause);
  }
  return true;
}

}  // namespace cohort::test
