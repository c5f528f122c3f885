// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/benchmarks/comparison/measuring/measure.hpp"

namespace cohort::bench {

struct BuildCost {
  std::string engine;
  Spread cpu;                      ///< CPU time of building all robots and stepping to tick 1 [s]
  double bytes_for_a_robot = 0.0;  ///< resident memory minus that of a world with one robot
};

struct BuildResult {
  std::string scene;
  std::uint32_t robots = 0;
  std::vector<BuildCost> costs;
  std::vector<LeftOut> left_out;
};

/// Builds a crowd in a child process for each engine and repetition, and a single robot in another. Call this before
/// building anything else in this process, so that the children begin with an empty heap. This process must have no
/// other thread.
BuildResult measure_build(const std::string& name, std::uint32_t robots, const std::vector<EngineKind>& engines,
                          const Options& options, const Surroundings& surroundings);

}  // namespace cohort::bench
