// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/benchmarks/comparison/lockstep/lockstep_rows.hpp"

/// Lines of tables, and JSON; docs/bench.md lists the keys.
namespace cohort::bench {

std::string lockstep_heading();
std::string line_of(const LockstepRow& row);
nlohmann::ordered_json to_json(const LockstepRow& row);

/// Returns the graph of rows of any placements as an SVG document.
std::string draw_rows(const std::vector<LockstepRow>& rows);

std::string look_ahead_heading();
std::string line_of(const LookAheadRow& row);
nlohmann::ordered_json to_json(const LookAheadRow& row);

}  // namespace cohort::bench
