// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/experiment/read_spawn.hpp"

#include <algorithm>
#include <string>

#include "server/core/names.hpp"
#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

constexpr const char* spawn_kind = "spawn";

// Returns the team of the new objects; empty if they are not robots, or, with a report, if the team is not clear.
std::string read_team(const ScheduleEntry& entry, const Model& model, const std::vector<Team>& teams) {
  const KeyValues& values = entry.values();
  const std::string team = values.has("team") ? values.text("team") : "";
  if (!model.is_robot()) {
    if (values.has("team"))
      entry.problem("team", "the model '" + model.name + "' is not a robot, so it cannot join a team");
    return "";
  }
  std::vector<std::string> names;
  std::string list;
  for (const Team& each : teams) {
    names.push_back(each.name);
    list += (list.empty() ? "" : ", ") + each.name;
  }
  if (values.has("team")) {
    if (std::ranges::find(names, team) == names.end())
      entry.problem("team", "there is no team '" + team + "'" + suggestion(team, names));
    return team;
  }
  if (names.size() == 1) return names.front();
  if (!names.empty()) entry.problem("team", "missing: the team of the new robots; expected one of " + list);
  return "";
}

void check_area(const ScheduleEntry& entry) {
  if ((entry.values().point("area").array() < 0.0).any()) entry.problem("area", "expected a size >= 0 m");
}

// Checks that a repetition is given exactly where the event can be repeated.
void check_repetition(const ScheduleEntry& entry, std::optional<std::chrono::nanoseconds> at, bool is_reaction) {
  const bool repeats = entry.is_written("every");
  if (is_reaction && repeats) entry.problem("every", "cannot be used together with `on`");
  if (!is_reaction && !repeats && entry.is_written("most"))
    entry.problem("most", "cannot be used without `every` or `on`; an event at a single time creates one object");
  if (at && at->count() == 0)
    entry.problem("objects cannot be spawned at 0 s; put initial objects into the world file");
}

void check_most(const ScheduleEntry& entry, const Experiment& experiment) {
  std::size_t total = 0;
  for (const Spawner& spawner : experiment.spawners) total += std::min(spawner.most, most_spawned + 1);
  if (total > most_spawned)
    entry.problem("most", "the events of an experiment can create at most " + std::to_string(most_spawned) +
                              " new objects in total, but these create more");
}

std::vector<Event> events_of(std::size_t spawner, std::chrono::nanoseconds first, std::size_t count,
                             std::chrono::nanoseconds every) {
  const std::chrono::nanoseconds longest = *schedule_time(9e9);
  std::vector<Event> events;
  for (std::chrono::nanoseconds time = first; events.size() < count; time += every) {
    events.push_back({time, 0, SpawnNew{spawner}, spawn_kind});
    if (every > longest - time) break;
  }
  return events;
}

}  // namespace

std::vector<Event> read_spawn_events(const ScheduleEntry& entry, std::optional<std::chrono::nanoseconds> at,
                                     bool is_reaction, Experiment& experiment) {
  const KeyValues& values = entry.values();
  check_repetition(entry, at, is_reaction);
  for (const char* key : {"model", "name", "pose", "area", "most"})
    if (!values.has(key)) return {};
  check_area(entry);
  Spawner spawner{values.text("name"), 0, values.pose("pose"), values.point("area"), "", 1};
  if (is_reaction || values.has("every")) spawner.most = static_cast<std::size_t>(values.whole("most"));
  if (!is_object_name(spawner.name + "_" + std::to_string(most_spawned)))
    entry.problem("name", "expected a name shorter than 250 bytes, with parts separated by single slashes");
  const auto& models = experiment.world.spawnable_models;
  const auto model = std::ranges::find(models, values.text("model"), &SpawnableModel::uri);
  if (model == models.end()) return {};  // which is reported with the world
  spawner.model = model->model;
  spawner.team = read_team(entry, experiment.world.models[spawner.model], experiment.teams);
  experiment.spawners.push_back(spawner);
  check_most(entry, experiment);
  const std::chrono::nanoseconds every = entry.time("every").value_or(std::chrono::nanoseconds(0));
  const std::size_t count = is_reaction ? 1 : std::min(spawner.most, most_spawned);
  return events_of(experiment.spawners.size() - 1, at.value_or(std::chrono::nanoseconds(0)), count, every);
}

}  // namespace cohort::parsing
