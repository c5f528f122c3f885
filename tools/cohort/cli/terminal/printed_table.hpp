#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/simulation/simulation.hpp"

namespace cohort::tool {

/// What an experiment prints, as a table with a line for each time at which something is due: CSV, with the time in the
/// first column and one column for each number. What is not due, or not in the world, leaves its columns empty.
class PrintedTable {
 public:
  /// `to_stdout`: each line is also printed as soon as it is there. Both must outlive this.
  PrintedTable(const description::Experiment& experiment, const Simulation& simulation, bool to_stdout);

  /// At each boundary.
  void boundary();

  const std::string& text() const { return text_; }

 private:
  void add_line(const std::string& line);

  const description::Experiment& experiment_;
  const Simulation& simulation_;
  bool to_stdout_;
  std::vector<std::uint64_t> every_;  // ticks, of each quantity
  std::string text_;
};

}  // namespace cohort::tool
