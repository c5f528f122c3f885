// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/thesis/thesis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "tests/benchmarks/comparison/measuring/clocks.hpp"

namespace cohort::bench {
namespace {

// Robots get new commands at multiples of this time [s], for any step.
constexpr double control_tick = 0.1;
constexpr double ours = 0.01;        // our step [s]
constexpr double thesis_step = 0.1;  // the thesis's [s]

struct Column {
  const char* engine;
  double step;  // [s]
};
constexpr Column columns[] = {{"cohort", ours},
                              {"ode-worldstep", ours},
                              {"ode-quickstep", ours},
                              {"ode-worldstep", thesis_step},
                              {"ode-quickstep", thesis_step}};

std::vector<std::string> column_names() {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(fmt::format("{} {:g} ms", column.engine, 1e3 * column.step));
  return names;
}

const EngineKind& kind_of(const std::string& engine) {
  const std::vector<EngineKind>& kinds = engine_kinds();
  return *std::find_if(kinds.begin(), kinds.end(), [&](const EngineKind& kind) { return kind.name == engine; });
}

ThesisCell measure_cell(const Column& column, Scene scene, const ThesisOptions& options,
                        const Surroundings& surroundings) {
  const EngineKind& kind = kind_of(column.engine);
  if (!kind.make) return {0.0, false, true};
  scene.step = column.step;
  const auto robots = static_cast<std::uint32_t>(scene.robots.size());
  surroundings.progress(fmt::format("{} robots: {}, steps of {:g} ms", robots, column.engine, 1e3 * column.step));
  try {
    const std::unique_ptr<Engine> engine = kind.make(scene, 1);
    RandomDriving driving(options.seed, robots);
    const auto ticks = static_cast<std::uint64_t>(std::max(1.0, std::round(options.seconds / control_tick)));
    const auto steps = static_cast<unsigned>(std::lround(control_tick / column.step));
    double cpu = 0.0;
    for (std::uint64_t tick = 0; tick < ticks; ++tick) {
      driving.update(tick, [&](std::uint32_t robot, const Command& command) { engine->set_command(robot, command); });
      const double before = cpu_seconds();
      for (unsigned i = 0; i < steps; ++i) engine->step();
      cpu += cpu_seconds() - before;
      if (surroundings.stop) throw Interrupted();
      if (cpu > options.budget && tick + 1 < ticks)
        return {cpu * static_cast<double>(ticks) / static_cast<double>(tick + 1), true, false};
    }
    return {cpu, false, false};
  } catch (const Interrupted&) {
    throw;
  } catch (const std::runtime_error&) {
    return {0.0, false, true};
  }
}

// Cell size and random displacement of robots on a plane without walls [m].
constexpr double room = 0.25;
constexpr double freedom = 0.05;

Scene random_scene(std::uint32_t robots, std::uint64_t seed) {
  Scene scene;
  scene.robots = in_cells(robots, room, freedom, seed);
  return scene;
}

// Returns rows of almost equal length, in which each robot is connected to the previous one.
Scene connected_scene(std::uint32_t robots) {
  Scene scene;
  scene.connected = true;
  std::uint32_t rows = 1;
  for (std::uint32_t i = 1; i * i <= robots; ++i)
    if (robots % i == 0) rows = i;
  const std::uint32_t in_row = robots / rows;
  for (std::uint32_t i = 0; i < robots; ++i) {
    const std::uint32_t row = i / in_row;
    const std::uint32_t place = row % 2 == 0 ? i % in_row : in_row - 1 - i % in_row;
    scene.robots.push_back({-scene.connection_length * place, scene.connection_length * row, 0.0});
  }
  return scene;
}

template <class MakeScene>
ThesisTable measure_table(const std::string& title, const std::vector<KnownRow>& known, const MakeScene& make_scene,
                          const ThesisOptions& options, const Surroundings& surroundings) {
  ThesisTable table;
  table.title = title;
  table.thesis_columns = {"worldstep", "quickstep"};
  table.columns = column_names();
  for (const KnownRow& each : wanted_rows(known, options)) {
    ThesisRow row{each.robots, each.seconds, {}};
    for (const Column& column : columns) {
      const bool is_ours = std::string_view(column.engine) == "cohort";
      row.cells.push_back(is_ours || each.robots <= last_of_ode
                              ? measure_cell(column, make_scene(each.robots), options, surroundings)
                              : ThesisCell{0.0, false, true});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Behaviour behaviour_of(const EngineKind& kind, double step) {
  constexpr double speed = 0.15;  // [m/s]
  constexpr double phase = 5.0;   // [s]
  Scene scene;
  scene.step = step;
  scene.robots = {{0.0, 0.0, 0.0}};
  Behaviour behaviour{kind.name, step};
  const auto steps = static_cast<unsigned>(std::lround(phase / step));
  double start_z = 0.0;
  const auto run = [&](Engine& engine, unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      engine.step();
      behaviour.sinking = std::max(behaviour.sinking, std::abs(engine.turret_centre(0).z() - start_z));
    }
    return Eigen::Vector2d(engine.turret_centre(0).head<2>());
  };
  {
    const std::unique_ptr<Engine> engine = kind.make(scene, 1);
    start_z = engine->turret_centre(0).z();
    engine->set_command(0, {speed, speed, 0.0});
    const unsigned last_steps = steps - steps / 2;
    const Eigen::Vector2d half = run(*engine, steps / 2);
    const Eigen::Vector2d whole = run(*engine, last_steps);
    behaviour.speed_ratio = (whole - half).norm() / (step * last_steps * speed);
  }
  {
    const std::unique_ptr<Engine> engine = kind.make(scene, 1);
    engine->set_command(0, {});
    const Eigen::Vector2d settled = run(*engine, static_cast<unsigned>(std::lround(1.0 / step)));
    behaviour.creep = (run(*engine, steps) - settled).norm();
  }
  return behaviour;
}

}  // namespace

std::vector<std::string> thesis_tables() { return {"5.1", "5.2", "5.3", "5.4", "behaviour"}; }

std::vector<KnownRow> wanted_rows(std::vector<KnownRow> known, const ThesisOptions& options) {
  if (options.robots.empty()) return known;
  std::vector<KnownRow> wanted;
  for (const std::uint32_t robots : options.robots) {
    const auto found = std::ranges::find(known, robots, &KnownRow::robots);
    if (found != known.end())
      wanted.push_back(*found);
    else
      wanted.push_back({robots, std::vector<std::optional<double>>(known.front().seconds.size())});
  }
  return wanted;
}

ThesisTable random_movement(const ThesisOptions& options, const Surroundings& surroundings) {
  const std::vector<KnownRow> known = {{1, {0.08638, 0.41086}},  {2, {0.16606, 0.81016}},   {4, {0.32694, 1.62109}},
                                       {8, {0.65303, 3.25002}},  {16, {1.40601, 6.50322}},  {32, {4.16268, 13.1822}},
                                       {64, {15.0444, 27.4801}}, {128, {52.1648, 57.5374}}, {1000, {{}, {}}},
                                       {10'000, {{}, {}}}};
  return measure_table(
      "Table 5.1, random movement", known, [&](std::uint32_t robots) { return random_scene(robots, options.seed); },
      options, surroundings);
}

ThesisTable connected_robots(const ThesisOptions& options, const Surroundings& surroundings) {
  const std::vector<KnownRow> known = {{1, {0.08638, 0.41086}}, {2, {0.41023, 0.84053}}, {4, {2.72198, 1.73786}},
                                       {6, {8.90234, 2.61219}}, {8, {24.8694, 3.49186}}, {12, {75.4717, 5.26593}},
                                       {16, {{}, 7.06165}},     {20, {{}, 8.88494}},     {25, {{}, 11.0939}},
                                       {128, {{}, {}}}};
  return measure_table(
      "Table 5.2, connected robots", known, [](std::uint32_t robots) { return connected_scene(robots); }, options,
      surroundings);
}

std::vector<Behaviour> behaviours(const Surroundings& surroundings) {
  std::vector<Behaviour> all;
  for (const Column& column : columns) {
    if (surroundings.stop) throw Interrupted();
    if (const EngineKind& kind = kind_of(column.engine); kind.make) all.push_back(behaviour_of(kind, column.step));
  }
  return all;
}

nlohmann::ordered_json measure_thesis(const ThesisOptions& options, const Surroundings& surroundings,
                                      const std::function<void(const std::string&)>& print) {
  nlohmann::ordered_json all{{"seed", options.seed},
                             {"seconds", options.seconds},
                             {"budget", options.budget},
                             {"cores", std::thread::hardware_concurrency()},
                             {"results", nlohmann::ordered_json::array()}};
  const auto take = [&](const auto& result) {
    print(text_of(result));
    all["results"].push_back(to_json(result));
  };
  print(
      fmt::format("CPU seconds for {:g} simulated seconds, one thread; *: extrapolated from {:g} s of CPU time.\n"
                  "The thesis measured on an Athlon XP 2800+ of 2003, with steps of 100 ms.\n",
                  options.seconds, options.budget));
  const auto is_wanted = [&](const char* table) {
    return options.tables.empty() || std::ranges::find(options.tables, table) != options.tables.end();
  };
  if (is_wanted("5.1")) take(random_movement(options, surroundings));
  if (is_wanted("5.2")) take(connected_robots(options, surroundings));
  if (is_wanted("5.3"))
    for (const ThesisTable& table : proximity_sensors(options, surroundings)) take(table);
  if (is_wanted("5.4")) take(light_and_sound(options, surroundings));
  if (is_wanted("behaviour")) take(behaviours(surroundings));
  return all;
}

}  // namespace cohort::bench
