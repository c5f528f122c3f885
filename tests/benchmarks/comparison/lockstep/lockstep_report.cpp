// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/lockstep/lockstep_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tests/benchmarks/comparison/measuring/report.hpp"
#include "tools/common/drawing/chart.hpp"

namespace cohort::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double micro = 1e6;
constexpr double milli = 1e3;

double median_of(const std::vector<LockstepTurn>& turns, double LockstepTurn::*quantity) {
  return spread_of(turns, quantity).median;
}

// Returns the part of a tick outside of the barrier: the world's step, and sensing.
double world_share(const LockstepRow& row) {
  std::vector<double> shares;
  for (const LockstepTurn& turn : row.cohort) shares.push_back(1.0 - turn.barrier_mean * turn.ticks_a_second);
  return spread_of(std::move(shares)).median;
}

Json turns_json(const std::vector<LockstepTurn>& turns) {
  return {{"ticks_per_s", spread_json(spread_of(turns, &LockstepTurn::ticks_a_second))},
          {"barrier_p50_us", spread_json(spread_of(turns, &LockstepTurn::barrier_median), micro)},
          {"barrier_p99_us", spread_json(spread_of(turns, &LockstepTurn::barrier_p99), micro)},
          {"server_cpu_us_per_tick", spread_json(spread_of(turns, &LockstepTurn::server_cpu), micro)},
          {"clients_cpu_us_per_tick", spread_json(spread_of(turns, &LockstepTurn::clients_cpu), micro)}};
}

std::string rate_of(double ticks_a_second) { return fmt::format("{:.0f}", ticks_a_second); }

using Quantity = double (*)(const LockstepRow&);

// Returns a line for each placement, with a dot for each number of robots.
std::vector<figures::Series> series_of(const std::vector<LockstepRow>& rows, const std::string& name,
                                       Quantity quantity) {
  std::vector<figures::Series> all;
  for (const auto& [place, placement] : placements()) {
    figures::Series series;
    series.name = name + place;
    series.is_joined = true;
    for (const LockstepRow& row : rows)
      if (row.placement == placement) series.measured.emplace_back(row.robots, quantity(row));
    std::ranges::sort(series.measured, {}, [](const auto& point) { return point.x(); });
    if (!series.measured.empty()) all.push_back(std::move(series));
  }
  return all;
}

}  // namespace

std::string draw_rows(const std::vector<LockstepRow>& rows) {
  const char* what = "by placement of the controllers";
  figures::Page page{"lockstep", "Lockstep barrier over DDS, compared with the same bytes over raw UDP", {}};
  page.panels.push_back(
      {"Barrier over DDS", what, "robots", "median, microseconds", series_of(rows, "", [](const LockstepRow& row) {
         return micro * median_of(row.cohort, &LockstepTurn::barrier_median);
       })});
  page.panels.push_back(
      {"Raw UDP", what, "robots", "median, microseconds", series_of(rows, "", [](const LockstepRow& row) {
         return micro * median_of(row.udp, &LockstepTurn::barrier_median);
       })});
  page.panels.push_back({"Ratio of tick rates", "including the world's step", "robots", "Cohort / raw UDP",
                         series_of(rows, "", [](const LockstepRow& row) { return row.ratio().median; })});
  for (figures::Panel& panel : page.panels) panel.is_log_x = true;
  page.panels[0].is_log_y = page.panels[1].is_log_y = true;
  return figures::draw(page);
}

std::string lockstep_heading() {
  return fmt::format("{:<8}{:>7}{:>10} |{:>9}{:>9}{:>9}{:>7}{:>16} |{:>9}{:>9}{:>16} |{:>7}{:>13}{:>9}\n", "place",
                     "robots", "processes", "ticks/s", "p50 us", "p99 us", "world", "CPU us serv+cl", "UDP t/s",
                     "p50 us", "CPU us serv+cl", "ratio", "min-max", "barrier");
}

std::string line_of(const LockstepRow& row) {
  const auto cpu = [](const std::vector<LockstepTurn>& turns) {
    return fmt::format("{:.0f}+{:.0f}", micro * median_of(turns, &LockstepTurn::server_cpu),
                       micro * median_of(turns, &LockstepTurn::clients_cpu));
  };
  const Spread ratio = row.ratio();
  return fmt::format(
      "{:<8}{:>7}{:>10} |{:>9}{:>9.0f}{:>9.0f}{:>6.0f}%{:>16} |{:>9}{:>9.0f}{:>16} |{:>7.2f}{:>13}{:>9.2f}\n",
      name_of(row.placement), row.robots, row.processes, rate_of(median_of(row.cohort, &LockstepTurn::ticks_a_second)),
      micro * median_of(row.cohort, &LockstepTurn::barrier_median),
      micro * median_of(row.cohort, &LockstepTurn::barrier_p99), 100.0 * world_share(row), cpu(row.cohort),
      rate_of(median_of(row.udp, &LockstepTurn::ticks_a_second)),
      micro * median_of(row.udp, &LockstepTurn::barrier_median), cpu(row.udp), ratio.median,
      fmt::format("{:.2f}-{:.2f}", ratio.least, ratio.most), row.barrier_ratio().median);
}

Json to_json(const LockstepRow& row) {
  return {{"placement", name_of(row.placement)},
          {"robots", row.robots},
          {"processes", row.processes},
          {"observation_bytes_per_tick", row.observation_bytes},
          {"command_bytes_per_tick", row.command_bytes},
          {"cohort", turns_json(row.cohort)},
          {"udp", turns_json(row.udp)},
          {"world_share", world_share(row)},
          {"ratio", spread_json(row.ratio())},
          {"barrier_ratio", spread_json(row.barrier_ratio())}};
}

std::string look_ahead_heading() {
  return fmt::format("{:>9}{:>7}{:>12}{:>8}{:>14}\n", "work ms", "delay", "tick ms", "ratio", "min-max");
}

std::string line_of(const LookAheadRow& row) {
  const Spread tick = spread_of(row.median);
  return fmt::format("{:>9.3g}{:>7}{:>12.3f}{:>8.2f}{:>14}\n", milli * row.work, row.delay, milli * tick.median,
                     tick.median / row.work, fmt::format("{:.2f}-{:.2f}", tick.least / row.work, tick.most / row.work));
}

Json to_json(const LookAheadRow& row) {
  return {{"delay", row.delay},
          {"work_ms", milli * row.work},
          {"tick_ms", spread_json(spread_of(row.median), milli)},
          {"ratio", spread_json(spread_of(row.median), 1.0 / row.work)}};
}

}  // namespace cohort::bench
