// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/process.hpp"

namespace cohort::test {

/// The output of `cohort bench`, and its files.
struct Measured {
  Ended ended;
  nlohmann::json json;
  std::string svg{};
};

/// Runs `cohort bench` with two repetitions. It writes a picture if it `draws`.
inline Measured measure(std::vector<std::string> arguments, bool draws = false) {
  const ScratchFolder folder;
  arguments.insert(arguments.begin(), {cohort_program(), "bench"});
  arguments.insert(arguments.end(), {"--repetitions", "2", "--json", (folder / "results.json").string()});
  if (draws) arguments.insert(arguments.end(), {"--svg", (folder / "graph.svg").string()});
  Measured measured{run_to_end(arguments), {}, {}};
  EXPECT_EQ(measured.ended.exit_code, 0) << measured.ended.err;
  measured.json = read_json(folder / "results.json");
  if (draws) measured.svg = read_file(folder / "graph.svg");
  return measured;
}

/// Checks the smallest, the median and the largest of several measurements.
inline void expect_spread(const nlohmann::json& spread) {
  EXPECT_GT(spread.value("min", 0.0), 0.0) << spread;
  EXPECT_LE(spread.value("min", 0.0), spread.value("median", 0.0)) << spread;
  EXPECT_LE(spread.value("median", 0.0), spread.value("max", 0.0)) << spread;
}

}  // namespace cohort::test
