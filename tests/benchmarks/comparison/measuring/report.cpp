// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/measuring/report.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cohort::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double micro = 1e6;
constexpr double milli = 1e3;
constexpr double mega = 1e-6;
constexpr double kibi = 1.0 / 1024.0;

std::string title(const std::string& scene, std::uint32_t robots, const std::string& more) {
  return fmt::format("{}, {} robot{}{}\n", scene, robots, robots == 1 ? "" : "s", more);
}

std::string or_dash(const std::optional<double>& value) { return value ? fmt::format("{:.2f}", *value) : "-"; }

std::string range_of(const Spread& spread, double unit) {
  return fmt::format("{:.4g}-{:.4g}", unit * spread.least, unit * spread.most);
}

std::string lines_of(const std::vector<LeftOut>& left_out) {
  std::string lines;
  for (const LeftOut& engine : left_out) lines += fmt::format("  skipped: {}: {}\n", engine.engine, engine.reason);
  return lines;
}

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

void add(Json& results, const std::vector<LeftOut>& left_out) {
  for (const LeftOut& engine : left_out) results.push_back({{"engine", engine.engine}, {"left_out", engine.reason}});
}

}  // namespace

Json spread_json(const Spread& spread, double unit) {
  return {{"median", unit * spread.median}, {"min", unit * spread.least}, {"max", unit * spread.most}};
}

std::string table(const StepResult& result) {
  const bool has_threads =
      std::any_of(result.costs.begin(), result.costs.end(), [](const auto& c) { return c.threads > 1; });
  std::string text = title(result.scene, result.robots, fmt::format(", steps of {:g} ms", milli * result.step));
  text += fmt::format("  {:<14}{:>9}{:>17}{:>10}{:>12}{:>8}{:>14}", "engine", "CPU us", "min-max", "touches",
                      result.connected ? "stretch mm" : "overlap mm", "speed", "vs quickstep");
  if (has_threads) text += fmt::format("{:>9}{:>9}{:>17}{:>10}", "threads", "wall us", "min-max", "speed-up");
  if (has_threads) text += fmt::format("{:>8}", "serial");
  text += '\n';
  for (const StepCost& cost : result.costs) {
    text += fmt::format("  {:<14}{:>9.2f}{:>17}{:>10.3f}{:>12.1f}{:>8.3f}{:>14}", cost.engine, micro * cost.cpu.median,
                        range_of(cost.cpu, micro), cost.touches, milli * cost.error, cost.speed_ratio,
                        or_dash(cost.against_reference));
    if (has_threads)
      text += fmt::format("{:>9}{:>9.2f}{:>17}{:>10}", cost.threads, micro * cost.wall.median,
                          range_of(cost.wall, micro), or_dash(cost.speed_up)) +
              fmt::format("{:>8}", cost.serial_share ? fmt::format("{:.1f}%", 100.0 * *cost.serial_share) : "-");
    text += '\n';
  }
  return text + lines_of(result.left_out);
}

std::string table(const BuildResult& result) {
  std::string text = title(result.scene, result.robots, ", built and stepped once");
  text += fmt::format("  {:<14}{:>9}{:>17}{:>14}\n", "engine", "CPU s", "min-max", "kB per robot");
  for (const BuildCost& cost : result.costs)
    text += fmt::format("  {:<14}{:>9.3f}{:>17}{:>14.1f}\n", cost.engine, cost.cpu.median, range_of(cost.cpu, 1.0),
                        kibi * cost.bytes_for_a_robot);
  return text + lines_of(result.left_out);
}

std::string table(const RayResult& result) {
  std::string text = title(result.scene, result.robots, ", 24 rays of 0.2 m each");
  text += fmt::format("  {:<14}{:>9}{:>17}{:>10}{:>12}\n", "density", "Mrays/s", "min-max", "hits", "spacing m");
  for (const RayCost& cost : result.costs)
    text += fmt::format("  {:<14}{:>9.2f}{:>17}{:>9.1f}%{:>12.2f}\n", cost.density, mega * cost.rays_a_second.median,
                        range_of(cost.rays_a_second, mega), 100.0 * cost.hits, cost.spacing);
  return text;
}

std::string table(const AccuracyResult& result) {
  std::string text = result.scene + ": deviation from the exact solution\n";
  bool has_heading = false;
  for (const AccuracyCase& of : result.cases) {
    if (!has_heading) {
      text += fmt::format("  {:<50}{:>6}", "case", "unit");
      for (const AccuracyError& error : of.errors)
        text += fmt::format("{:>21}", fmt::format("{} {:g} ms", error.engine, milli * error.step));
      text += '\n';
      has_heading = true;
    }
    text += fmt::format("  {:<50}{:>6}", of.name, of.unit);
    for (const AccuracyError& error : of.errors) text += fmt::format("{:>21.2g}", error.error);
    text += '\n';
  }
  return text;
}

Json to_json(const StepResult& result) {
  Json engines = Json::array();
  for (const StepCost& cost : result.costs)
    engines.push_back({{"engine", cost.engine},
                       {"threads", cost.threads},
                       {"cpu_us_per_robot_step", spread_json(cost.cpu, micro)},
                       {"wall_us_per_robot_step", spread_json(cost.wall, micro)},
                       {"touches_per_robot", cost.touches},
                       {result.connected ? "connection_error_m" : "deepest_overlap_m", cost.error},
                       {"speed_ratio", cost.speed_ratio},
                       {"vs_ode_quickstep", optional_json(cost.against_reference)},
                       {"speed_up", optional_json(cost.speed_up)},
                       {"serial_share", optional_json(cost.serial_share)}});
  add(engines, result.left_out);
  return {{"scene", result.scene}, {"robots", result.robots}, {"step_s", result.step}, {"engines", engines}};
}

Json to_json(const BuildResult& result) {
  Json engines = Json::array();
  for (const BuildCost& cost : result.costs)
    engines.push_back({{"engine", cost.engine},
                       {"cpu_s", spread_json(cost.cpu)},
                       {"resident_bytes_per_robot", cost.bytes_for_a_robot}});
  add(engines, result.left_out);
  return {{"scene", result.scene}, {"robots", result.robots}, {"engines", engines}};
}

Json to_json(const RayResult& result) {
  Json densities = Json::array();
  for (const RayCost& cost : result.costs)
    densities.push_back({{"density", cost.density},
                         {"spacing_m", cost.spacing},
                         {"hit_share", cost.hits},
                         {"mrays_per_s", spread_json(cost.rays_a_second, mega)}});
  return {{"scene", result.scene}, {"robots", result.robots}, {"densities", densities}};
}

Json to_json(const AccuracyResult& result) {
  Json cases = Json::array();
  for (const AccuracyCase& of : result.cases) {
    Json errors = Json::array();
    for (const AccuracyError& error : of.errors)
      errors.push_back({{"engine", error.engine}, {"step_s", error.step}, {"error", error.error}});
    cases.push_back({{"case", of.name}, {"unit", of.unit}, {"errors", errors}});
  }
  return {{"scene", result.scene}, {"cases", cases}};
}

}  // namespace cohort::bench
