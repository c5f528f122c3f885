// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/simulation/simulation.hpp"

namespace cohort::tool {

/// The values that an experiment prints, as CSV with a line for each time at which a value is due. The first column is
/// the time; each number has its own column. A column is empty if its value is not due, or its object not in the world.
class PrintedTable {
 public:
  /// `to_stdout`: also print each line as soon as it is complete. Experiment and simulation must outlive this.
  PrintedTable(const description::Experiment& experiment, const Simulation& simulation, bool to_stdout);

  /// Adds the values that are due; called at each tick boundary.
  void boundary();

  const std::string& text() const { return text_; }
  bool is_on_stdout() const { return to_stdout_; }

 private:
  void add_line(const std::string& line);

  const description::Experiment& experiment_;
  const Simulation& simulation_;
  bool to_stdout_;
  std::vector<std::uint64_t> every_;  // interval of each quantity in ticks
  std::string text_;
};

}  // namespace cohort::tool
