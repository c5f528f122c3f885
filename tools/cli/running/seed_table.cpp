// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/seed_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "idl/include/cohort/version.h"
#include "tools/cli/common/wording.hpp"
#include "tools/common/data/csv_tables.hpp"

namespace cohort::tool {
namespace {

double percent_of_ticks(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

struct SeedColumn {
  const char* title;  // for people
  const char* name;   // in CSV
  int decimals;
  std::function<double(const SeedRow&)> value;
};

const std::vector<SeedColumn>& seed_columns() {
  static const std::vector<SeedColumn> all = {
      {"ticks", "ticks", 0, [](const SeedRow& row) { return static_cast<double>(row.ticks); }},
      {"simulated [s]", "simulated_s", 2, [](const SeedRow& row) { return row.sim_time; }},
      {"wall [s]", "wall_s", 2, [](const SeedRow& row) { return row.wall; }},
      {"CPU [s]", "cpu_s", 2, [](const SeedRow& row) { return row.cpu; }},
      {"real-time factor", "real_time_factor", 1, [](const SeedRow& row) { return row.real_time_factor(); }},
      {"obstacle contact [%]", "obstacle_contacts_percent", 2,
       [](const SeedRow& row) { return percent_of_ticks(row.obstacles, row.robot_ticks); }},
      {"robot contact [%]", "robot_contacts_percent", 2,
       [](const SeedRow& row) { return percent_of_ticks(row.robots, row.robot_ticks); }},
      {"late", "late_answers", 0, [](const SeedRow& row) { return static_cast<double>(row.late); }},
  };
  return all;
}

using TableLines = std::vector<std::vector<std::string>>;

// Right-justified, but for the last column.
std::string aligned_lines(const TableLines& lines) {
  std::vector<std::size_t> widths(lines.front().size());
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text;
  for (const auto& line : lines) {
    std::string row;
    for (std::size_t i = 0; i < line.size(); ++i)
      row += i + 1 == line.size() ? line[i] : fmt::format("{:>{}}  ", line[i], widths[i]);
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

std::string table_of_rows(const std::vector<SeedRow>& rows) {
  const bool stopped = std::ranges::any_of(rows, [](const SeedRow& row) { return !row.stop_reason.empty(); });
  TableLines lines = {{"seed"}};
  for (const SeedColumn& column : seed_columns()) lines.front().emplace_back(column.title);
  lines.front().emplace_back("state hash");
  if (stopped) lines.front().emplace_back("stopped by");
  for (const SeedRow& row : rows) {
    auto& line = lines.emplace_back(1, std::to_string(row.seed));
    for (const SeedColumn& column : seed_columns())
      line.push_back(fmt::format("{:.{}f}", column.value(row), column.decimals));
    line.push_back(row.state_hash);
    if (stopped) line.push_back(row.stop_reason);
  }
  if (rows.size() < 2) return aligned_lines(lines);
  const auto count = static_cast<double>(rows.size());
  std::vector<std::string> means = {"mean"};
  std::vector<std::string> deviations = {"std"};
  for (const SeedColumn& column : seed_columns()) {
    double mean = 0.0;
    for (const SeedRow& row : rows) mean += column.value(row) / count;
    double squares = 0.0;
    for (const SeedRow& row : rows) squares += std::pow(column.value(row) - mean, 2);
    const int decimals = std::max(column.decimals, 1);
    means.push_back(fmt::format("{:.{}f}", mean, decimals));
    deviations.push_back(fmt::format("{:.{}f}", std::sqrt(squares / (count - 1.0)), decimals));
  }
  for (auto* line : {&means, &deviations}) line->resize(lines.front().size());
  lines.push_back(means);
  lines.push_back(deviations);
  return aligned_lines(lines);
}

}  // namespace

SeedRow seed_row(std::uint64_t run, const description::Experiment& experiment, const session::RunResult& result,
                 double cpu_seconds) {
  return {.run = run,
          .experiment = experiment.name,
          .seed = experiment.seed,
          .ticks = result.ticks,
          .sim_time = seconds(result.sim_time),
          .wall = seconds(result.wall_time),
          .cpu = cpu_seconds,
          .robot_ticks = result.touches.robot_ticks,
          .obstacles = result.touches.obstacles,
          .robots = result.touches.robots,
          .late = result.late,
          .stop_reason = result.stop_reason,
          .state_hash = fmt::format("{:016x}", result.state_hash)};
}

std::string seed_table(std::vector<SeedRow> rows) {
  std::ranges::sort(rows, {}, &SeedRow::run);
  std::string text;
  while (!rows.empty()) {
    const std::string name = rows.front().experiment;
    const auto others =
        std::stable_partition(rows.begin(), rows.end(), [&](const SeedRow& row) { return row.experiment == name; });
    const std::vector<SeedRow> of_it(rows.begin(), others);
    rows.erase(rows.begin(), others);
    text += (text.empty() ? "" : "\n") +
            fmt::format("experiment {}, {} (Cohort {})\n", name, counted(of_it.size(), "run"), COHORT_VERSION);
    text += table_of_rows(of_it);
  }
  return text;
}

std::string seed_csv(std::vector<SeedRow> rows) {
  std::ranges::sort(rows, {}, &SeedRow::run);
  std::string text = "experiment,seed";
  for (const SeedColumn& column : seed_columns()) text += fmt::format(",{}", column.name);
  text += ",stopped_by,state_hash\n";
  for (const SeedRow& row : rows) {
    text += fmt::format("{},{}", data::csv_cell(row.experiment), row.seed);
    for (const SeedColumn& column : seed_columns()) text += fmt::format(",{}", column.value(row));
    text += fmt::format(",{},{}\n", data::csv_cell(row.stop_reason), row.state_hash);
  }
  return text;
}

}  // namespace cohort::tool
