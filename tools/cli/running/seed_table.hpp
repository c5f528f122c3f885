// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/description/experiment.hpp"
#include "server/run/run.hpp"

namespace cohort::tool {

/// The main results of one run of several.
struct SeedRow {
  std::uint64_t run = 0;  ///< number of the run, from 1
  std::string experiment{};
  std::uint64_t seed = 0;
  std::uint64_t ticks = 0;
  double sim_time = 0.0;  ///< [s]
  double wall = 0.0;      ///< [s]
  double cpu = 0.0;       ///< [s]
  std::uint64_t robot_ticks = 0;
  std::uint64_t obstacles = 0;  ///< robot-ticks in contact with an obstacle
  std::uint64_t robots = 0;     ///< robot-ticks in contact with another robot
  std::uint64_t late = 0;       ///< answers
  std::string stop_reason{};
  std::string state_hash{};

  double real_time_factor() const { return wall > 0.0 ? sim_time / wall : 0.0; }
};

SeedRow seed_row(std::uint64_t run, const description::Experiment& experiment, const session::RunResult& result,
                 double cpu_seconds);

/// Returns the rows as text for the user, in the order of their runs: a table for each experiment. A table of two rows
/// or more has the mean and the sample standard deviation of its columns.
std::string seed_table(std::vector<SeedRow> rows);

/// Returns the rows as CSV, in the order of their runs, with the units in the header.
std::string seed_csv(std::vector<SeedRow> rows);

}  // namespace cohort::tool
