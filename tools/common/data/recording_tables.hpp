// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <set>
#include <string>

#include "server/recording/recording.hpp"
#include "tools/common/data/table.hpp"

namespace cohort::data {

/// The part of a recording that is written.
struct Selection {
  std::chrono::nanoseconds from{0};                               ///< log time
  std::chrono::nanoseconds to = std::chrono::nanoseconds::max();  ///< log time, inclusive
  std::set<std::string> robots{};                                 ///< with commands and observations; empty: all
};

/// Writes the tables of docs/recordings.md, "Tables". The column `run` numbers the worlds of the recording, from 0;
/// `time` is simulated time [s]. Returns the number of rows. Throws McapError, or std::runtime_error from the sink.
std::uint64_t write_tables(const recording::Recording& recording, const Selection& selection, TableSink& sink);

}  // namespace cohort::data
