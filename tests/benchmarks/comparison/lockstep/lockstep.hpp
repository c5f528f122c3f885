// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/benchmarks/comparison/lockstep/lockstep_rows.hpp"

namespace cohort::bench {

struct LockstepResults {
  nlohmann::ordered_json json;
  std::string graph;  ///< an SVG document
};
/// Measures one row after the other, and passes each finished row to `print`. Throws Interrupted, and
/// std::runtime_error if a process fails.
LockstepResults measure_lockstep(const LockstepOptions& options, const Surroundings& surroundings,
                                 const std::function<void(const std::string&)>& print);

}  // namespace cohort::bench
