// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "tests/benchmarks/comparison/thesis/thesis.hpp"

namespace cohort::bench {
namespace {

std::string seconds_of(const std::optional<double>& seconds) { return seconds ? fmt::format("{:.3g}", *seconds) : "-"; }

std::string text_of(const ThesisCell& cell) {
  if (cell.is_missing) return "-";
  return fmt::format("{:.3g}{}", cell.seconds, cell.is_extrapolated ? "*" : "");
}

// Returns text that is right-aligned under a heading.
std::string in_column(const std::string& heading, const std::string& text) {
  constexpr std::size_t least = 8;
  return fmt::format("  {:>{}}", text, std::max(least, heading.size()));
}

// Returns a line for each row, formatted by `thesis_text` and `cell_text`.
template <class ThesisText, class CellText>
std::string lines_of(const ThesisTable& table, ThesisText thesis_text, CellText cell_text) {
  std::string text;
  for (const ThesisRow& row : table.rows) {
    text += fmt::format("  {:>7}", row.robots);
    for (std::size_t i = 0; i < row.thesis.size(); ++i)
      text += in_column("thesis " + table.thesis_columns[i], thesis_text(row.thesis[i]));
    for (std::size_t i = 0; i < row.cells.size(); ++i)
      text += in_column(table.columns[i], cell_text(row, row.cells[i]));
    text += "\n";
  }
  return text;
}

std::string no_text(const std::optional<double>&) { return {}; }

nlohmann::ordered_json to_json(const ThesisCell& cell, std::uint32_t robots, std::uint64_t frames) {
  nlohmann::ordered_json json{{"seconds", cell.seconds}, {"extrapolated", cell.is_extrapolated}};
  if (frames > 0) json["us_per_robot_frame"] = cost_of_robot_frame(cell, robots, frames);
  if (cell.answer) json["answer"] = *cell.answer;
  return json;
}

}  // namespace

double cost_of_robot_frame(const ThesisCell& cell, std::uint32_t robots, std::uint64_t frames) {
  return 1e6 * cell.seconds / (static_cast<double>(frames) * robots);
}

std::string text_of(const ThesisTable& table) {
  std::string text = table.title + "\n  " + fmt::format("{:>7}", "robots");
  for (const std::string& column : table.thesis_columns) text += in_column("thesis " + column, "thesis " + column);
  for (const std::string& column : table.columns) text += in_column(column, column);
  text += "\n";
  text += lines_of(table, seconds_of, [](const ThesisRow&, const ThesisCell& cell) { return text_of(cell); });
  if (table.frames > 0)
    text += "  microseconds per robot and frame:\n" +
            lines_of(table, no_text, [&](const ThesisRow& row, const ThesisCell& cell) {
              return cell.is_missing ? "-" : fmt::format("{:.2f}", cost_of_robot_frame(cell, row.robots, table.frames));
            });
  if (!table.answers.empty())
    text += "  " + table.answers + ":\n" + lines_of(table, no_text, [](const ThesisRow&, const ThesisCell& cell) {
              return cell.answer ? fmt::format("{:.4f}", *cell.answer) : "-";
            });
  if (!table.note.empty()) text += "  " + table.note + "\n";
  return text;
}

std::string text_of(const std::vector<Behaviour>& behaviours) {
  std::string text = "Behaviour of a single robot\n";
  text +=
      fmt::format("  {:<16}{:>9}{:>8}{:>19}{:>13}\n", "engine", "step ms", "speed", "creep mm in 5 s", "sinking mm");
  for (const Behaviour& each : behaviours)
    text += fmt::format("  {:<16}{:>9g}{:>8.3f}{:>19.3f}{:>13.3f}\n", each.engine, 1e3 * each.step, each.speed_ratio,
                        1e3 * each.creep, 1e3 * each.sinking);
  return text;
}

nlohmann::ordered_json to_json(const ThesisTable& table) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ThesisRow& row : table.rows) {
    nlohmann::ordered_json json{{"robots", row.robots}};
    for (std::size_t i = 0; i < row.thesis.size(); ++i)
      json["thesis " + table.thesis_columns[i]] =
          row.thesis[i] ? nlohmann::ordered_json(*row.thesis[i]) : nlohmann::ordered_json(nullptr);
    for (std::size_t i = 0; i < row.cells.size(); ++i)
      if (!row.cells[i].is_missing) json[table.columns[i]] = to_json(row.cells[i], row.robots, table.frames);
    rows.push_back(std::move(json));
  }
  return {{"table", table.title}, {"rows", rows}};
}

nlohmann::ordered_json to_json(const std::vector<Behaviour>& behaviours) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Behaviour& each : behaviours)
    rows.push_back({{"engine", each.engine},
                    {"step_s", each.step},
                    {"speed_ratio", each.speed_ratio},
                    {"creep_m", each.creep},
                    {"sinking_m", each.sinking}});
  return {{"table", "behaviour"}, {"rows", rows}};
}

}  // namespace cohort::bench
