// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/experiment/read_schedule.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "server/core/text.hpp"
#include "server/description/select_robots.hpp"
#include "server/parsing/experiment/read_effects.hpp"
#include "server/parsing/experiment/read_recorded.hpp"
#include "server/parsing/experiment/read_spawn.hpp"
#include "server/parsing/experiment/schedule_entry.hpp"
#include "server/parsing/keys/choices.hpp"
#include "server/parsing/keys/experiment_keys.hpp"
#include "server/parsing/world/read_world.hpp"
#include "server/parsing/yaml/yaml_values.hpp"

namespace cohort::parsing {
namespace {

// Returns the names of the parts that are allowed in a list of the experiment.
std::vector<std::string> kinds_in(std::string_view list) {
  std::vector<std::string> kinds;
  for (const Extension& part : experiment_parts())
    if (part.parent == list) kinds.emplace_back(part.name);
  return kinds;
}

bool is_when(std::string_view key) { return key == "at" || key == "on"; }

std::string either_of(const std::vector<std::string>& kinds) {
  std::string text;
  for (const std::string& kind : kinds) text += (text.empty() ? "" : ", ") + kind;
  return text;
}

}  // namespace

struct ScheduleReader::Written {
  std::string path;  // path of the kind, such as `events[0].add`
  std::string kind;
  const YamlNode* map = nullptr;  // keys of the kind
  std::optional<std::chrono::nanoseconds> time{};
  const YamlNode* on = nullptr;  // the action that triggers it, instead of a time
  std::string on_path;
};

struct ScheduleReader::ReadEvent {
  Event event;
  const YamlNode* node = nullptr;
  std::string path;
};

namespace {

using Condition = decltype(StopCondition::what);
using ReadCondition = std::optional<Condition> (*)(const ScheduleEntry& entry);

std::optional<Condition> read_inside(const ScheduleEntry& entry) {
  const KeyValues& values = entry.values();
  if (!values.has("min") || !values.has("max")) return std::nullopt;
  if ((values.point("min").array() > values.point("max").array()).any()) entry.problem("min", "exceeds max");
  return AllInside{values.point("min"), values.point("max")};
}
std::optional<Condition> read_beyond(const ScheduleEntry& entry) {
  const KeyValues& values = entry.values();
  if (!values.has("point") || !values.has("direction")) return std::nullopt;
  if (values.point("direction").isZero()) entry.problem("direction", "expected a direction that is not zero");
  return OneBeyond{values.point("point"), values.point("direction")};
}
std::optional<Condition> read_at_rest(const ScheduleEntry& entry) {
  const KeyValues& values = entry.values();
  if (!values.has("speed") || !values.has("turn_rate")) return std::nullopt;
  return AllAtRest{values.real("speed"), values.real("turn_rate")};
}
std::optional<Condition> read_quarantined(const ScheduleEntry&) { return OneQuarantined{}; }

constexpr std::pair<std::string_view, ReadCondition> conditions[] = {
    {"inside", &read_inside}, {"beyond", &read_beyond}, {"at_rest", &read_at_rest}, {"quarantined", &read_quarantined}};

ReadCondition reader_of(std::string_view kind) {
  const auto found = std::ranges::find(conditions, kind, &std::pair<std::string_view, ReadCondition>::first);
  if (found == std::end(conditions)) throw std::logic_error("nothing reads " + std::string(kind));
  return found->second;
}

bool is_of_joints(Quantity quantity) { return quantity == Quantity::joint_force || quantity == Quantity::joint_torque; }

// Returns the selected joints, ascending; reports selectors that match none.
std::vector<std::size_t> selected_joints(const ScheduleEntry& entry, const World& world) {
  std::set<std::size_t> selected;
  std::vector<std::string> names;
  for (const BreakableJoint& joint : world.breakable_joints) names.push_back(joint.name);
  for (const std::string& selector : entry.values().texts("joints")) {
    bool selects = false;
    for (std::size_t joint = 0; joint < names.size(); ++joint) {
      if (!matches(names[joint], selector)) continue;
      selected.insert(joint);
      selects = true;
    }
    if (!selects)
      entry.problem("joints", "there is no breakable joint '" + selector + "'" + suggestion(selector, names));
  }
  return {selected.begin(), selected.end()};
}

}  // namespace

void ScheduleReader::choose_kind(const YamlMap& map, const std::vector<std::string>& kinds, Written& written) {
  for (const std::string& kind : kinds) {
    if (!map.has(kind)) continue;
    if (!written.kind.empty()) {
      map.problem(kind, "unexpected key; each entry of this list must have exactly one key of this kind");
      continue;
    }
    written.kind = kind;
    written.map = &map.where(kind);
    written.path = map.path_to(kind);
  }
}

void ScheduleReader::read_when(const YamlMap& map, Written& written) {
  if (map.has("on")) {
    written.on = &map.where("on");
    written.on_path = map.path_to("on");
    if (map.has("at")) map.problem("on", "cannot be used together with `at`");
    return;
  }
  map.require("at", "time of the event, in seconds of simulated time; or `on`, the action that triggers it");
  const std::optional<double> seconds = map.real("at");
  if (!seconds) return;
  const std::optional<std::chrono::nanoseconds> time = schedule_time(*seconds);
  if (!time) map.problem("at", "expected a time from 0 s to 9e9 s");
  written.time = time;
}

std::vector<ScheduleReader::Written> ScheduleReader::entries(const std::string& list, bool have_times) const {
  std::vector<Written> found;
  if (!top_.has(list)) return found;
  const YamlNode& nodes = top_.where(list);
  if (!nodes.is_list()) {
    top_.problem(list, "expected a list, not " + shown(nodes));
    return found;
  }
  const std::vector<std::string> kinds = kinds_in(list);
  std::vector<std::string> known = kinds;
  if (have_times) known.insert(known.begin(), {"at", "on"});
  for (std::size_t i = 0; i < nodes.items.size(); ++i) {
    const YamlNode& node = *nodes.items[i];
    const std::string path = list + "[" + std::to_string(i) + "]";
    const YamlMap map(node, path, known, report_);
    if (!node.is_map()) continue;
    Written written;
    if (have_times) read_when(map, written);
    choose_kind(map, kinds, written);
    if (!written.kind.empty())
      found.push_back(written);
    else if (std::ranges::all_of(node.pairs,
                                 [](const auto& pair) { return pair.first->is_scalar() && is_when(pair.first->text); }))
      report_.problem(node, path, "missing: one of " + either_of(kinds));
  }
  return found;
}

std::vector<LaterObject> ScheduleReader::later_objects() const {
  // Problems are reported when the whole list is read.
  std::vector<Problem> ignored;
  std::vector<LaterObject> objects;
  if (!top_.has("events") || !top_.where("events").is_list()) return objects;
  const YamlNode& nodes = top_.where("events");
  const YamlReport nothing(file_, ignored);
  for (std::size_t i = 0; i < nodes.items.size(); ++i)
    for (const std::string kind : {"add", "spawn"}) {
      const YamlNode* const added = nodes.items[i]->find(kind);
      if (added == nullptr || !added->is_map()) continue;
      const std::string path = "events[" + std::to_string(i) + "]." + kind;
      const KeyValues values = read_values(*added, path, experiment_part(kind, "events"), true, nothing);
      if (!values.has("model") || !values.has("name") || !values.has("pose")) continue;
      objects.push_back({values.text("model"),
                         values.text("name"),
                         values.pose("pose"),
                         {file_, added->line, path, ""},
                         kind == "spawn"});
    }
  return objects;
}

void ScheduleReader::read(Experiment& experiment) const {
  read_events(experiment);
  read_stops(experiment);
  read_prints(experiment);
  read_history(experiment);
  read_recorded(experiment);
}

void ScheduleReader::read_events(Experiment& experiment) const {
  std::vector<ReadEvent> events;
  std::vector<Event> at_any_time;
  for (const Written& written : entries("events", true)) {
    std::vector<ReadEvent> read =
        written.kind == "spawn" ? read_spawn(written, experiment) : read_event(written, experiment.world);
    if (written.on_path.empty()) {
      std::move(read.begin(), read.end(), std::back_inserter(events));
      continue;
    }
    std::optional<Reaction> reaction = read_on(written, experiment.world);
    if (!reaction) continue;
    for (const ReadEvent& each : read) reaction->events.push_back(each.event);
    at_any_time.insert(at_any_time.end(), reaction->events.begin(), reaction->events.end());
    experiment.reactions.push_back(*std::move(reaction));
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const ReadEvent& a, const ReadEvent& b) { return a.event.time < b.event.time; });
  check_order(experiment.world, events, at_any_time);
  for (ReadEvent& each : events) experiment.events.push_back(std::move(each.event));
}

// Reads a reaction of the selected robots that have the action.
std::optional<Reaction> ScheduleReader::read_on(const Written& written, const World& world) const {
  const ScheduleEntry entry(*written.on, written.on_path, experiment_part("on", "an event"), report_);
  const KeyValues& values = entry.values();
  if (!values.has("action") || !values.has("robots")) return std::nullopt;
  std::set<std::uint32_t> chosen;
  for (const std::string& selector : values.texts("robots")) {
    try {
      for (const std::uint32_t robot : select_robots(world, selector)) chosen.insert(robot);
    } catch (const std::invalid_argument& error) {
      entry.problem("robots", error.what());
      return std::nullopt;
    }
  }
  Reaction reaction{values.text("action"), {}, {}};
  std::set<std::string> known;
  for (const std::uint32_t robot : chosen)
    for (const Device& device : world.robot_model(robot).devices) {
      if (!std::holds_alternative<UserAction>(device)) continue;
      known.insert(name_of(device));
      if (name_of(device) == reaction.action) reaction.robots.push_back(robot);
    }
  if (!reaction.robots.empty()) return reaction;
  entry.problem("action", "none of the selected robots has an action '" + reaction.action + "'" +
                              suggestion(reaction.action, {known.begin(), known.end()}));
  return std::nullopt;
}

std::vector<ScheduleReader::ReadEvent> ScheduleReader::read_event(const Written& written, const World& world) const {
  const ScheduleEntry entry(*written.map, written.path, experiment_part(written.kind, "events"), report_);
  std::vector<std::size_t> objects;
  if (written.kind == "add") {
    const auto is_added = [&](const Instance& instance) {
      return entry.values().has("name") && instance.name == entry.values().text("name");
    };
    const auto found = std::find_if(world.instances.begin(), world.instances.end(), is_added);
    if (found != world.instances.end()) objects.push_back(static_cast<std::size_t>(found - world.instances.begin()));
  } else {
    objects = entry.objects(world);
  }
  std::vector<ReadEvent> events;
  for (auto& [object, effect] : read_effects(written.kind, entry, world, objects))
    events.push_back({{written.time.value_or(std::chrono::nanoseconds(0)), object, std::move(effect), written.kind},
                      written.map,
                      written.path});
  return events;
}

std::vector<ScheduleReader::ReadEvent> ScheduleReader::read_spawn(const Written& written,
                                                                  Experiment& experiment) const {
  const ScheduleEntry entry(*written.map, written.path, experiment_part(written.kind, "events"), report_);
  std::vector<ReadEvent> events;
  for (Event& event : read_spawn_events(entry, written.time, !written.on_path.empty(), experiment))
    events.push_back({std::move(event), written.map, written.path});
  return events;
}

// Reports events for objects that have been removed or not yet added. Objects that are added by actions of robots may
// be present at any time.
void ScheduleReader::check_order(const World& world, const std::vector<ReadEvent>& events,
                                 const std::vector<Event>& at_any_time) const {
  std::vector<char> is_there(world.instances.size());
  std::vector<char> is_gone(world.instances.size(), 0);
  for (std::size_t i = 0; i < world.instances.size(); ++i) is_there[i] = world.instances[i].is_present ? 1 : 0;
  for (const Event& event : at_any_time)
    if (event.kind == "add") is_there[event.object] = 1;
  for (const ReadEvent& each : events) {
    const Event& event = each.event;
    if (std::holds_alternative<SpawnNew>(event.effect)) continue;
    const std::string name = "'" + world.instances[event.object].name + "'";
    if (is_gone[event.object])
      report_.problem(*each.node, each.path, name + " has been removed before this event");
    else if (event.kind != "add" && !is_there[event.object])
      report_.problem(*each.node, each.path, name + " has not been added before this event");
    if (event.kind == "add") is_there[event.object] = 1;
    if (event.kind == "remove" && is_there[event.object]) is_gone[event.object] = 1;
  }
}

void ScheduleReader::read_stops(Experiment& experiment) const {
  for (const Written& written : entries("stop", false)) {
    const ScheduleEntry entry(*written.map, written.path, experiment_part(written.kind, "stop"), report_);
    StopCondition condition{written.kind, entry.objects(experiment.world), OneQuarantined{},
                            entry.time("for").value_or(std::chrono::nanoseconds(0))};
    if (const auto what = reader_of(written.kind)(entry)) {
      condition.what = *what;
      experiment.stops.push_back(std::move(condition));
    }
  }
}

void ScheduleReader::read_prints(Experiment& experiment) const {
  if (!top_.has("print")) return;
  const YamlNode& nodes = top_.where("print");
  if (!nodes.is_list()) return top_.problem("print", "expected a list, not " + shown(nodes));
  for (std::size_t i = 0; i < nodes.items.size(); ++i) {
    const ScheduleEntry entry(*nodes.items[i], "print[" + std::to_string(i) + "]",
                              experiment_part("print", "experiment"), report_);
    const KeyValues& values = entry.values();
    const std::optional<std::chrono::nanoseconds> every = entry.time("every");
    PrintedQuantity printed;
    for (const std::string& selector : values.texts("objects"))
      printed.selector += (printed.selector.empty() ? "" : " ") + selector;
    if (!values.has("quantity") || !every) continue;
    printed.quantity = choice_of<Quantity>(quantities, values.text("quantity"));
    const bool of_joints = is_of_joints(printed.quantity);
    if (const std::string stray = of_joints ? "objects" : "joints"; entry.is_written(stray))
      entry.problem(stray, "cannot be used with the quantity '" + values.text("quantity") + "'");
    if (of_joints)
      printed.joints = selected_joints(entry, experiment.world);
    else
      printed.objects = entry.objects(experiment.world);
    printed.every = *every;
    experiment.prints.push_back(std::move(printed));
  }
}

void ScheduleReader::read_history(Experiment& experiment) const {
  if (!top_.has("history")) return;
  const ScheduleEntry entry(top_.where("history"), "history", experiment_part("history", "experiment"), report_);
  experiment.history.objects = entry.objects(experiment.world);
  if (entry.values().has("length"))
    experiment.history.length = static_cast<std::size_t>(entry.values().whole("length"));
  experiment.history.every = entry.time("every").value_or(std::chrono::nanoseconds(0));
}

void ScheduleReader::read_recorded(Experiment& experiment) const {
  Recorded& recorded = experiment.recorded;
  recorded.observed.resize(experiment.world.robots.size());
  std::iota(recorded.observed.begin(), recorded.observed.end(), 0u);
  if (!top_.has("record")) return;
  parsing::read_recorded(
      ScheduleEntry(top_.where("record"), "record", experiment_part("record", "experiment"), report_), experiment.world,
      recorded);
}

}  // namespace cohort::parsing
