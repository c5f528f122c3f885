// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "server/core/processors.hpp"
#include "server/description/experiment.hpp"
#include "server/recording/difference.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/refuse_experiment.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/cli/common/terminal/replay_progress.hpp"
#include "tools/cli/common/wording.hpp"

namespace cohort::tool {
namespace {

struct DiffCommand {
  std::filesystem::path first;
  std::filesystem::path second;
  bool json = false;
};

using Seconds = std::chrono::duration<double>;

std::string line_of(const recording::QuantityDifference& difference) {
  std::string values = difference.first;
  if (!difference.second.empty()) values += " | " + difference.second;
  return fmt::format("  {:<12} {:<24} {}: {}", difference.quantity,
                     difference.object.empty() ? "the world" : difference.object, difference.detail, values);
}

// A setting of the runs that differs, and what it is in each.
struct DifferingSetting {
  std::string name;
  std::string first;
  std::string second;
};

using Settings = std::map<std::string, std::string>;

std::string joined_text(const std::vector<std::string>& values) { return fmt::format("{}", fmt::join(values, ", ")); }

Settings settings_of(const recording::Recording& recording) {
  Settings settings;
  for (const char* const name : {"experiment", "world", "robots", "version", "commit", "arithmetic"})
    if (const auto fact = recording.facts().find(name); fact != recording.facts().end()) settings[name] = fact->second;
  const recording::Recording::World& world = recording.worlds().front();
  const auto seconds_text = [](std::chrono::nanoseconds time) { return fmt::format("{} s", Seconds(time).count()); };
  settings["seed"] = std::to_string(world.begins.seed);
  settings["duration"] = seconds_text(std::chrono::nanoseconds(world.begins.duration_ns));
  const description::Experiment experiment = recording.experiment(world);
  settings["step"] = seconds_text(experiment.world.step);
  for (const description::Team& team : experiment.teams) {
    settings["controller of team '" + team.name + "'"] = std::filesystem::path(team.controller).filename().string();
    for (const description::Parameter& each : team.parameters)
      settings["parameter '" + each.name + "' of team '" + team.name + "'"] = joined_text(each.values);
  }
  return settings;
}

// Returns what differs, the seed first.
std::vector<DifferingSetting> differing_settings(const recording::Recording& first,
                                                 const recording::Recording& second) {
  const Settings of_first = settings_of(first);
  const Settings of_second = settings_of(second);
  Settings all = of_first;
  all.insert(of_second.begin(), of_second.end());
  const auto value = [](const Settings& settings, const std::string& name) {
    const auto found = settings.find(name);
    return found == settings.end() ? std::string("none") : found->second;
  };
  std::vector<DifferingSetting> differing;
  for (const auto& [name, ignored] : all) {
    DifferingSetting each{name, value(of_first, name), value(of_second, name)};
    if (each.first != each.second) differing.insert(name == "seed" ? differing.begin() : differing.end(), each);
  }
  return differing;
}

void print_settings(const std::vector<DifferingSetting>& settings) {
  if (settings.empty()) return;
  show("the runs have different settings:\n");
  for (const DifferingSetting& each : settings)
    show(fmt::format("  {}: {} | {}\n", each.name, each.first, each.second));
}

void print_text(const recording::Comparison& found) {
  if (!found.parting && found.ends.empty())
    return show(fmt::format("identical, {}\n", counted(found.boundaries, "tick")));
  if (!found.parting)
    return show(fmt::format("{}; until then, they are identical, {}\n", found.ends, counted(found.boundaries, "tick")));
  show(fmt::format("they diverge at tick {} ({:.3f} s), after {}\n", found.parting->tick,
                   Seconds(found.parting->log_time).count(), counted(found.boundaries, "identical tick")));
  for (const auto& difference : found.parting->differences) show(line_of(difference) + "\n");
  if (found.parting->more > 0) show(fmt::format("  and {} more\n", found.parting->more));
}

void print_json(const std::vector<DifferingSetting>& settings, const recording::Comparison& found) {
  nlohmann::ordered_json differing = nlohmann::ordered_json::array();
  for (const DifferingSetting& each : settings)
    differing.push_back({{"setting", each.name}, {"first", each.first}, {"second", each.second}});
  nlohmann::ordered_json json = {{"settings", differing},
                                 {"identical_ticks", found.boundaries},
                                 {"identical", !found.parting && found.ends.empty()}};
  if (!found.ends.empty()) json["ends"] = found.ends;
  if (found.parting) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const auto& each : found.parting->differences)
      list.push_back({{"object", each.object},
                      {"quantity", each.quantity},
                      {"detail", each.detail},
                      {"first", each.first},
                      {"second", each.second}});
    json["tick"] = found.parting->tick;
    json["time_s"] = Seconds(found.parting->log_time).count();
    json["differences"] = list;
    json["more"] = found.parting->more;
  }
  show(json_text(json, 2) + "\n");
}

int diff(const DiffCommand& command, Log& log, const std::atomic<bool>& stop) {
  for (const std::filesystem::path& file : {command.first, command.second}) refuse_experiment(file);
  const recording::Recording first(command.first);
  const recording::Recording second(command.second);
  for (const recording::Recording* each : {&first, &second})
    if (!each->damage().empty()) log.warning(each->damage());
  const std::vector<DifferingSetting> settings = differing_settings(first, second);
  if (!command.json) print_settings(settings);
  flush_output();
  ReplayProgress progress(log);
  const recording::Comparison found =
      recording::compare(first, second, available_processors(), [&](std::chrono::nanoseconds log_time) {
        progress.at(log_time, "compared");
        return !stop;
      });
  log.clear_progress();
  if (stop) return exit_interrupted;
  if (command.json)
    print_json(settings, found);
  else
    print_text(found);
  return found.parting || !found.ends.empty() ? exit_failed : exit_ok;
}

}  // namespace

Subcommand add_diff(CommandLine app) {
  const auto command = std::make_shared<DiffCommand>();
  CommandLine line =
      app.add_subcommand("diff", "Find the first tick at which two recorded runs differ, and show the differences");
  line.add_option("FIRST", command->first, "Recording (MCAP)").required().type_name("");
  line.add_option("SECOND", command->second, "Recording to compare it with (MCAP)").required().type_name("");
  line.add_flag("--json", command->json, "Print the result as JSON");
  line.footer("Example: cohort diff monday.mcap tuesday.mcap");
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return diff(*command, log, stop); }};
}

}  // namespace cohort::tool
