// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/summary_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "server/simulation/build_identity.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/cli/common/wording.hpp"

namespace cohort::tool {
namespace {

nlohmann::ordered_json quantiles(const lockstep::LatencyHistogram& histogram) {
  return {{"p50", microseconds(histogram.quantile(0.5))},
          {"p99", microseconds(histogram.quantile(0.99))},
          {"max", microseconds(histogram.max())}};
}

}  // namespace

void write_summary(const std::filesystem::path& file, const description::Experiment& experiment,
                   const session::RunResult& result, double cpu_seconds, const StageTimes& times) {
  const double wall = seconds(result.wall_time);
  nlohmann::ordered_json events = nlohmann::ordered_json::array();
  for (const session::RunEvent& event : result.events)
    events.push_back({{"tick", event.tick}, {"kind", event.kind}, {"text", event.text}, {"count", event.count}});
  const auto name_of = [&](std::uint32_t robot) {
    const std::size_t at_first = experiment.world.robots.size();
    return robot < at_first ? experiment.world.robot(robot).name : result.newcomers.at(robot - at_first);
  };
  nlohmann::ordered_json misses = nlohmann::ordered_json::array();
  for (const session::Miss& miss : result.misses)
    misses.push_back({{"tick", miss.tick},
                      {"frame", miss.frame_tick},
                      {"robot", name_of(miss.robot)},
                      {"on_late", word_of(miss.consequence)},
                      {"waited_s", seconds(miss.waited)}});
  nlohmann::ordered_json summary = {
      {"experiment", experiment.name},
      {"seed", experiment.seed},
      {"version", this_build().version},
      {"commit", this_build().commit},
      {"ticks", result.ticks},
      {"sim_time_ns", result.sim_time.count()},
      {"wall_s", wall},
      {"cpu_s", cpu_seconds},
      {"real_time_factor", wall > 0.0 ? seconds(result.sim_time) / wall : 0.0},
      {"state_hash", fmt::format("{:016x}", result.state_hash)},
      {"robots", result.robots},
      {"missing_meshes", experiment.world.replaced_meshes},
      {"barrier_us", quantiles(result.barrier)},
      {"late", result.late},
      {"resent", result.resent},
      {"repeated", result.repeated},
      {"misses", misses},
      {"lateness_us", quantiles(result.lateness)},
      {"late_ticks", result.late_ticks},
      {"events", events},
      {"stop_reason", result.stop_reason},
      {"touches",
       {{"robot_ticks", result.touches.robot_ticks},
        {"obstacles", result.touches.obstacles},
        {"robots", result.touches.robots}}},
      {"convergence",
       {{"groups", result.convergence.solved},
        {"unconverged", result.convergence.unconverged},
        {"worst", result.convergence.worst},
        {"minima", result.convergence.minima},
        {"most_minima", result.convergence.most_minima},
        {"steps", result.convergence.steps},
        {"factorisations", result.convergence.factorisations}}},
  };
  for (const StageTimes::Stage& stage : times.stages())
    summary["stages_s"][std::string(stage.name)] = seconds(stage.time);
  if (!times.stages().empty()) summary["stages_s"]["controllers"] = seconds(result.barrier.sum());
  write_file("the summary", file, json_text(summary, 2) + "\n");
}

SeedRow read_seed_row(std::uint64_t run, const std::filesystem::path& file) {
  std::ifstream stream(file);
  const nlohmann::json summary = nlohmann::json::parse(stream);
  const nlohmann::json& touches = summary.at("touches");
  return {.run = run,
          .experiment = summary.at("experiment"),
          .seed = summary.at("seed"),
          .ticks = summary.at("ticks"),
          .sim_time = seconds(std::chrono::nanoseconds(summary.at("sim_time_ns"))),
          .wall = summary.at("wall_s"),
          .cpu = summary.at("cpu_s"),
          .robot_ticks = touches.at("robot_ticks"),
          .obstacles = touches.at("obstacles"),
          .robots = touches.at("robots"),
          .late = summary.at("late"),
          .stop_reason = summary.at("stop_reason"),
          .state_hash = summary.at("state_hash")};
}

}  // namespace cohort::tool
