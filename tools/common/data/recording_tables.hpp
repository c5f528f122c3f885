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
  std::chrono::nanoseconds to = std::chrono::nanoseconds::max();  ///< the same, also in it
  std::set<std::string> robots{};                                 ///< with their commands and observations; empty: all
};

/// Writes the tables of docs/recordings.md, "Tables". `run` counts the worlds of the recording, from 0; `time` is
/// simulated time in seconds. Returns how many rows there are. Throws McapError, or std::runtime_error of the sink.
std::uint64_t write_tables(const recording::Recording& recording, const Selection& selection, TableSink& sink);

}  // namespace cohort::data
