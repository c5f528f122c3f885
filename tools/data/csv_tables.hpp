#pragma once

#include <filesystem>

#include "tools/data/table.hpp"

namespace cohort::data {

/// `NAME.csv` in a folder for each table: RFC 4180 with a line of names, numbers as the shortest text that reads as the
/// same float64, no units. Makes the folder. Throws std::runtime_error if it cannot.
std::unique_ptr<TableSink> csv_tables(const std::filesystem::path& folder);

}  // namespace cohort::data
