// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/benchmarks/comparison/measuring/accuracy.hpp"
#include "tests/benchmarks/comparison/measuring/build_cost.hpp"
#include "tests/benchmarks/comparison/measuring/rays.hpp"

/// Results as tables and as JSON; docs/bench.md lists the keys.
namespace cohort::bench {

std::string table(const StepResult& result);
std::string table(const BuildResult& result);
std::string table(const RayResult& result);
std::string table(const AccuracyResult& result);

nlohmann::ordered_json spread_json(const Spread& spread, double unit = 1.0);
nlohmann::ordered_json to_json(const StepResult& result);
nlohmann::ordered_json to_json(const BuildResult& result);
nlohmann::ordered_json to_json(const RayResult& result);
nlohmann::ordered_json to_json(const AccuracyResult& result);

}  // namespace cohort::bench
