#pragma once

#include <filesystem>
#include <string>

#include "tools/common/data/table.hpp"

namespace cohort::data {

/// Returns `text` as a cell of CSV: in quotes if it has a comma, a quote or a line break.
std::string csv_cell(const std::string& text);

/// `NAME.csv` in a folder for each table: RFC 4180 with a line of names, numbers as the shortest text that reads as the
/// same float64. `units.json` beside them has the units by table and column. Makes the folder.
/// Throws std::runtime_error if it cannot.
std::unique_ptr<TableSink> csv_tables(const std::filesystem::path& folder);

}  // namespace cohort::data
