// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tools/common/data/table.hpp"

namespace cohort::data {

/// Returns `text` as a cell of CSV: in quotes if it has a comma, a quote or a line break.
std::string csv_cell(const std::string& text);

/// Writes each table to `NAME.csv` in a folder, as in RFC 4180 with a header line. Numbers are written as the shortest
/// text that reads as the same float64. `units.json` in the folder has the units by table and column. Creates the
/// folder. Throws std::runtime_error if this fails.
std::unique_ptr<TableSink> csv_tables(const std::filesystem::path& folder);

}  // namespace cohort::data
