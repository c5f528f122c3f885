#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/measuring/measure.hpp"

/// The benchmarks of the thesis of 2005 (section 5.1), run again: the same numbers of robots for 100 simulated seconds,
/// in Cohort and in ODE, the engine of the thesis, side by side.
namespace cohort::bench {

/// With more robots only Cohort goes on.
inline constexpr std::uint32_t last_of_ode = 1000;

struct ThesisOptions {
  double seconds = 100.0;  ///< simulated, of each cell
  double budget = 2.0;     ///< CPU time that a cell may take before the rest is extrapolated [s]
  std::uint64_t seed = 1;
  std::vector<std::string> tables;    ///< of thesis_tables(); empty: all
  std::vector<std::uint32_t> robots;  ///< empty: those of the thesis, and more
};

/// CPU time for so many simulated seconds.
struct ThesisCell {
  double seconds = 0.0;
  bool is_extrapolated = false;       ///< from a part of the run
  bool is_missing = false;            ///< not in this build, not asked for, or it gave up
  std::optional<double> answer = {};  ///< of tables 5.3 and 5.4: what was measured, by which columns can be compared
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
  std::uint64_t frames = 0;  ///< of each cell; 0: the costs of a robot and frame are not of interest
  std::string answers = {};  ///< what the answers of the cells are; empty: they have none
  std::string note = {};     ///< a line for the end
};

/// Numbers of robots, and the thesis's seconds for them.
struct KnownRow {
  std::uint32_t robots = 0;
  std::vector<std::optional<double>> seconds;
};
/// The rows for the robots that are asked for.
std::vector<KnownRow> wanted_rows(std::vector<KnownRow> known, const ThesisOptions& options);

double cost_of_robot_frame(const ThesisCell& cell, std::uint32_t robots, std::uint64_t frames);  ///< [us]

/// Names for ThesisOptions::tables.
std::vector<std::string> thesis_tables();

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
/// Table 5.3: proximity sensors of robots that stand still, in frames of the thesis's 100 ms and of 10 ms.
std::vector<ThesisTable> proximity_sensors(const ThesisOptions& options, const Surroundings& surroundings);
/// Table 5.4: light sensors and microphones among 24 lamps and 24 sounds.
ThesisTable light_and_sound(const ThesisOptions& options, const Surroundings& surroundings);
std::vector<Behaviour> behaviours(const Surroundings& surroundings);

std::string text_of(const ThesisTable& table);
std::string text_of(const std::vector<Behaviour>& behaviours);
nlohmann::ordered_json to_json(const ThesisTable& table);
nlohmann::ordered_json to_json(const std::vector<Behaviour>& behaviours);

/// All of it; `print` gets each part as soon as it is there. Throws Interrupted.
nlohmann::ordered_json measure_thesis(const ThesisOptions& options, const Surroundings& surroundings,
                                      const std::function<void(const std::string&)>& print);

}  // namespace cohort::bench
