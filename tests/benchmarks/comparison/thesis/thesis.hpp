// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/benchmarks/comparison/measuring/measure.hpp"

/// The benchmarks of the thesis of 2005 (section 5.1), repeated with the same numbers of robots for 100 simulated
/// seconds, in Cohort and in ODE, the engine of the thesis.
namespace cohort::bench {

/// Largest number of robots in ODE; Cohort simulates more.
inline constexpr std::uint32_t last_of_ode = 1000;

struct ThesisOptions {
  double seconds = 100.0;  ///< simulated time of each cell [s]
  double budget = 2.0;     ///< limit of CPU time for a cell; the rest is extrapolated [s]
  std::uint64_t seed = 1;
  std::vector<std::string> tables;    ///< names from thesis_tables(); empty: all
  std::vector<std::uint32_t> robots;  ///< empty: those of the thesis, and larger ones
};

/// The CPU time for the given simulated time.
struct ThesisCell {
  double seconds = 0.0;
  bool is_extrapolated = false;       ///< from a part of the run
  bool is_missing = false;            ///< not part of this build, not requested, or failed
  std::optional<double> answer = {};  ///< for tables 5.3 and 5.4: the measured value, for comparing columns
};

struct ThesisRow {
  std::uint32_t robots = 0;
  std::vector<std::optional<double>> thesis;  ///< times of the thesis [s], in the order of ThesisTable::thesis_columns
  std::vector<ThesisCell> cells;              ///< in the order of ThesisTable::columns
};

struct ThesisTable {
  std::string title;
  std::vector<std::string> thesis_columns;
  std::vector<std::string> columns;
  std::vector<ThesisRow> rows;
  std::uint64_t frames = 0;  ///< frames of each cell; 0: do not show the cost per robot and frame
  std::string answers = {};  ///< meaning of the cells' answers; empty: they have none
  std::string note = {};     ///< a line below the table
};

/// A number of robots, and the times of the thesis for it.
struct KnownRow {
  std::uint32_t robots = 0;
  std::vector<std::optional<double>> seconds;
};
/// Returns the rows for the requested numbers of robots.
std::vector<KnownRow> wanted_rows(std::vector<KnownRow> known, const ThesisOptions& options);

double cost_of_robot_frame(const ThesisCell& cell, std::uint32_t robots, std::uint64_t frames);  ///< [us]

/// Returns the names for ThesisOptions::tables.
std::vector<std::string> thesis_tables();

/// The behaviour of a single robot at a step size, which shows the quality of a fast result.
struct Behaviour {
  std::string engine;
  double step = 0.0;         ///< [s]
  double speed_ratio = 0.0;  ///< ratio of reached to commanded speed, driving straight
  double creep = 0.0;        ///< displacement in 5 s of a robot that is commanded zero speed [m]
  double sinking = 0.0;      ///< maximum vertical displacement of a turret's centre from its start [m]
};

ThesisTable random_movement(const ThesisOptions& options, const Surroundings& surroundings);   ///< table 5.1
ThesisTable connected_robots(const ThesisOptions& options, const Surroundings& surroundings);  ///< table 5.2
/// Measures table 5.3: proximity sensors of robots at rest, in frames of the thesis's 100 ms and of 10 ms.
std::vector<ThesisTable> proximity_sensors(const ThesisOptions& options, const Surroundings& surroundings);
/// Measures table 5.4: light sensors and microphones among 24 lamps and 24 sounds.
ThesisTable light_and_sound(const ThesisOptions& options, const Surroundings& surroundings);
std::vector<Behaviour> behaviours(const Surroundings& surroundings);

std::string text_of(const ThesisTable& table);
std::string text_of(const std::vector<Behaviour>& behaviours);
nlohmann::ordered_json to_json(const ThesisTable& table);
nlohmann::ordered_json to_json(const std::vector<Behaviour>& behaviours);

/// Measures all tables, and passes each finished part to `print`. Throws Interrupted.
nlohmann::ordered_json measure_thesis(const ThesisOptions& options, const Surroundings& surroundings,
                                      const std::function<void(const std::string&)>& print);

}  // namespace cohort::bench
