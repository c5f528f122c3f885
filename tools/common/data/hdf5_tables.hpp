// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/common/data/table.hpp"

namespace cohort::data {

/// Writes all tables to one HDF5 file: a dataset of compound rows for each table, chunked and compressed, whose
/// attribute `units` has a text for each column. Replaces the file. Throws std::runtime_error if this fails.
std::unique_ptr<TableSink> hdf5_tables(const std::filesystem::path& file);

}  // namespace cohort::data
