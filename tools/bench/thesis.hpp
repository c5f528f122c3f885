#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/measure.hpp"

/// The benchmarks of the thesis of 2005 (section 5.1), run again: the same numbers of robots for 100 simulated seconds,
/// in Cohort and in ODE, the engine of the thesis, side by side.
namespace cohort::bench {

struct ThesisOptions {
  double seconds = 100.0;  ///< simulated, of each cell
  double budget = 2.0;     ///< CPU time that a cell may take before the rest is extrapolated [s]
  std::uint64_t seed = 1;
};

/// CPU time for so many simulated seconds.
struct ThesisCell {
  double seconds = 0.0;
  bool is_extrapolated = false;  ///< from a part of the run
  bool is_missing = false;       ///< not in this build, or it gave up
};

struct ThesisRow {
  std::uint32_t robots = 0;
  std::vector<std::optional<double>> thesis;  ///< its seconds, in the order of ThesisTable::thesis_columns
  std::vector<ThesisCell> cells;              ///< in the order of ThesisTable::columns
};

struct ThesisTable {
  std::string title;
  std::vector<std::string> thesis_columns;
  std::vector<std::string> columns;
  std::vector<ThesisRow> rows;
};

/// What one robot alone does at a step size: what a fast answer is worth.
struct Behaviour {
  std::string engine;
  double step = 0.0;         ///< [s]
  double speed_ratio = 0.0;  ///< reached to commanded, straight on
  double creep = 0.0;        ///< way of a robot that is told to stand still, in 5 s [m]
  double sinking = 0.0;      ///< the most that a turret's centre is below or above where it began [m]
};

ThesisTable random_movement(const ThesisOptions& options, const Surroundings& surroundings);   ///< table 5.1
ThesisTable connected_robots(const ThesisOptions& options, const Surroundings& surroundings);  ///< table 5.2
std::vector<Behaviour> behaviours(const Surroundings& surroundings);

std::string text_of(const ThesisTable& table);
std::string text_of(const std::vector<Behaviour>& behaviours);
nlohmann::ordered_json to_json(const ThesisTable& table);
nlohmann::ordered_json to_json(const std::vector<Behaviour>& behaviours);

/// All of it; `print` gets each part as soon as it is there. Throws Interrupted.
nlohmann::ordered_json measure_thesis(const ThesisOptions& options, const Surroundings& surroundings,
                                      const std::function<void(const std::string&)>& print);

}  // namespace cohort::bench
