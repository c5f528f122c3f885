// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/benchmarks/comparison/engines/sensing_run.hpp"
#include "tests/benchmarks/comparison/measuring/clocks.hpp"
#include "tests/benchmarks/comparison/thesis/thesis.hpp"

namespace cohort::bench {
namespace {

using description::ProximityTechnique;

constexpr unsigned repetitions = 5;   // each with its own seed
constexpr double thesis_frame = 0.1;  // [s]
constexpr std::uint32_t swarm = 1000;
constexpr std::size_t both = 2;  // the column of table 5.4 with light and sound

struct Way {
  std::string name;
  std::function<std::unique_ptr<SensingRun>(const SensingScene&)> make;  // empty: not in this build
  bool is_ode = false;
};

struct Measured {
  std::vector<double> seconds_a_frame;  // one value for each repetition
  bool is_cut_short = false;
  std::optional<double> answer;  // answer of the first repetition
};

// Reads the clock only occasionally, because a frame may take a microsecond.
void measure_frames(SensingRun& run, std::uint64_t frames, double budget, Measured& into) {
  constexpr std::uint64_t most_at_once = 64;
  run.sense();  // excludes one-time work and fills caches
  double cpu = 0.0;
  std::uint64_t done = 0;
  for (std::uint64_t at_once = 1; done < frames && cpu <= budget; at_once = std::min(2 * at_once, most_at_once)) {
    const std::uint64_t count = std::min(at_once, frames - done);
    const double before = cpu_seconds();
    for (std::uint64_t i = 0; i < count; ++i) run.sense();
    cpu += cpu_seconds() - before;
    done += count;
  }
  into.seconds_a_frame.push_back(cpu / static_cast<double>(done));
  into.is_cut_short = into.is_cut_short || done < frames;
  if (!into.answer) into.answer = run.answer();
}

ThesisCell cell_of(const Measured& measured, std::uint64_t frames) {
  if (measured.seconds_a_frame.empty()) return {0.0, false, true, {}};
  return {spread_of(measured.seconds_a_frame).median * static_cast<double>(frames), measured.is_cut_short, false,
          measured.answer};
}

// Measures all methods alternately, then again in the next scene.
template <class MakeScene>
ThesisRow measure_row(const KnownRow& known, const MakeScene& make_scene, const std::vector<Way>& ways,
                      std::uint64_t frames, const ThesisOptions& options, const Surroundings& surroundings) {
  std::vector<Measured> measured(ways.size());
  for (unsigned repetition = 0; repetition < repetitions; ++repetition) {
    surroundings.progress(fmt::format("{} robots: repetition {} of {}", known.robots, repetition + 1, repetitions));
    const SensingScene scene = make_scene(known.robots, options.seed + repetition);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      if (!ways[i].make || (ways[i].is_ode && known.robots > last_of_ode)) continue;
      if (surroundings.stop) throw Interrupted();
      measure_frames(*ways[i].make(scene), frames, options.budget / repetitions, measured[i]);
    }
  }
  ThesisRow row{known.robots, known.seconds, {}};
  for (const Measured& each : measured) row.cells.push_back(cell_of(each, frames));
  return row;
}

template <class MakeScene>
void measure_rows(ThesisTable& table, const std::vector<KnownRow>& known, const MakeScene& make_scene,
                  const std::vector<Way>& ways, const ThesisOptions& options, const Surroundings& surroundings) {
  for (const Way& way : ways) table.columns.push_back(way.name);
  for (const KnownRow& each : wanted_rows(known, options))
    table.rows.push_back(measure_row(each, make_scene, ways, table.frames, options, surroundings));
}

std::uint64_t frames_of(const ThesisOptions& options, double frame) {
  return static_cast<std::uint64_t>(std::max(1.0, std::round(options.seconds / frame)));
}

std::vector<Way> ways_of_proximity() {
  const auto of = [](ProximityTechnique technique) {
    return [technique](const SensingScene& scene) { return make_cohort_proximity(scene, technique); };
  };
  std::vector<Way> ways = {
      {"ray", of(ProximityTechnique::ray)},
      {"samples", of(ProximityTechnique::samples)},
      {"shadow", of(ProximityTechnique::shadow)},
      {"random_ray", of(ProximityTechnique::random_ray)},
      {"five_rays", of(ProximityTechnique::five_rays)},
      {"ray, whole tick",
       [](const SensingScene& scene) { return make_cohort_proximity_ticks(scene, ProximityTechnique::ray); }},
      {"ODE rays", {}, true},
  };
  if constexpr (COHORT_BENCH_ODE) ways.back().make = make_ode_proximity;
  return ways;
}

std::vector<Way> ways_of_sources() {
  const auto of = [](Perceived perceived) {
    return [perceived](const SensingScene& scene) { return make_cohort_sources(scene, perceived); };
  };
  std::vector<Way> ways = {
      {"light", of(Perceived::light)},
      {"sound", of(Perceived::sound)},
      {"both", of(Perceived::both)},
      {"both, whole tick", [](const SensingScene& scene) { return make_cohort_sources_ticks(scene, Perceived::both); }},
      {"ODE rays of light", {}, true},
  };
  if constexpr (COHORT_BENCH_ODE) ways.back().make = make_ode_visibility;
  return ways;
}

}  // namespace

std::vector<ThesisTable> proximity_sensors(const ThesisOptions& options, const Surroundings& surroundings) {
  const std::vector<KnownRow> known = {{1, {0.17729, 0.17282, 0.15556}},
                                       {2, {0.22601, 0.19191, 0.17658}},
                                       {4, {0.33981, 0.22606, 0.21904}},
                                       {8, {0.57722, 0.30498, 0.30375}},
                                       {16, {1.34214, 0.47401, 0.54493}},
                                       {32, {4.04531, 1.09081, 1.55296}},
                                       {64, {12.8800, 3.16847, 3.63465}},
                                       {128, {{}, {}, {}}},
                                       {1000, {{}, {}, {}}},
                                       {10'000, {{}, {}, {}}}};
  std::vector<ThesisTable> tables;
  for (const double frame : {thesis_frame, 0.01}) {
    ThesisTable table;
    table.frames = frames_of(options, frame);
    table.title = fmt::format("Table 5.3, proximity sensors: {} frames of {:g} ms", table.frames, 1e3 * frame);
    // The thesis has times for its own frames only.
    if (frame == thesis_frame) table.thesis_columns = {"raytracing", "sampling", "shadow"};
    std::vector<KnownRow> rows = known;
    if (frame != thesis_frame)
      for (KnownRow& row : rows) row.seconds.clear();
    table.answers = "mean reading";
    const auto make_scene = [&](std::uint32_t robots, std::uint64_t seed) {
      SensingScene scene = among_obstacles(robots, seed);
      scene.scene.step = frame;
      return scene;
    };
    measure_rows(table, rows, make_scene, ways_of_proximity(), options, surroundings);
    tables.push_back(std::move(table));
  }
  return tables;
}

ThesisTable light_and_sound(const ThesisOptions& options, const Surroundings& surroundings) {
  std::vector<KnownRow> rows;
  for (const std::uint32_t robots : {1, 2, 4, 8, 16, 32, 64, 128, 1000, 10'000}) rows.push_back({robots, {}});
  ThesisTable table;
  table.frames = frames_of(options, thesis_frame);
  table.title = fmt::format(
      "Table 5.4, light and sound: {} frames, 24 lamps and 24 sounds (the thesis shows a figure without numbers)",
      table.frames);
  table.answers = "fraction of visible lamps";
  const auto make_scene = [&](std::uint32_t robots, std::uint64_t seed) {
    SensingScene scene = among_sources(robots, seed);
    scene.scene.step = 0.01;
    return scene;
  };
  measure_rows(table, rows, make_scene, ways_of_sources(), options, surroundings);
  for (const ThesisRow& row : table.rows)
    if (row.robots == swarm)
      table.note = fmt::format(
          "24 lamps and 24 sounds, {} robots with 8 light sensors and 4 microphones: {:.2f} us per robot and frame "
          "(goal: less than 5)",
          swarm, cost_of_robot_frame(row.cells[both], row.robots, table.frames));
  return table;
}

}  // namespace cohort::bench
