#pragma once

#include <filesystem>

#include "tools/common/data/table.hpp"

namespace cohort::data {

/// One HDF5 file with a dataset of compound rows for each table, chunked and compressed; a dataset has the attribute
/// `units`, a text for each column. Replaces the file. Throws std::runtime_error if it cannot.
std::unique_ptr<TableSink> hdf5_tables(const std::filesystem::path& file);

}  // namespace cohort::data
