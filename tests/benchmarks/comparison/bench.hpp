// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/benchmarks/comparison/measuring/measure.hpp"

namespace cohort::bench {

std::vector<std::string> scene_names();
std::vector<std::string> engine_names();

/// Throws std::invalid_argument if a requested engine is not part of this build.
void check_engines(const Options& options);

/// Returns a line for each engine that this build lacks, with its Debian package; empty if none is missing.
std::string missing_engines();

/// Measures one scene after the other, and passes each finished table to `print`. Returns all results. Throws
/// Interrupted.
nlohmann::ordered_json measure_all(const Options& options, const Surroundings& surroundings,
                                   const std::function<void(const std::string&)>& print);

}  // namespace cohort::bench
