// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tests/support/process.hpp"

namespace cohort::test {

/// Runs `cohort` with these arguments to its end.
inline Ended cohort(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), cohort_program());
  return run_to_end(arguments);
}

}  // namespace cohort::test
