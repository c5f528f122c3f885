// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/benchmarks/comparison/measuring/measure.hpp"

namespace cohort::bench {

/// The error of an engine in one case.
struct AccuracyError {
  std::string engine;
  double step = 0.0;  ///< [s]
  double error = 0.0;
};
struct AccuracyCase {
  std::string name;
  std::string unit;
  std::vector<AccuracyError> errors;
};
struct AccuracyResult {
  std::string scene;
  std::vector<AccuracyCase> cases;
};

/// Measures systems with a known solution in steps of 10 ms and 1 ms, in each engine that can build them.
AccuracyResult measure_accuracy(const std::string& name, const std::vector<EngineKind>& engines,
                                const Surroundings& surroundings);

}  // namespace cohort::bench
