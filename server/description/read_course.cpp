#include "server/description/read_course.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include "server/description/experiment_keys.hpp"
#include "server/description/select_robots.hpp"
#include "server/description/text.hpp"
#include "server/description/yaml_values.hpp"

namespace cohort::description {
namespace {

constexpr double longest = 9e9;  // 285 years, which fits into nanoseconds

std::optional<std::chrono::nanoseconds> to_time(double seconds) {
  if (!(seconds >= 0.0 && seconds <= longest)) return std::nullopt;
  return std::chrono::nanoseconds(static_cast<std::int64_t>(std::round(seconds * 1e9)));
}

// The names of the parts that may stand in a list of the experiment.
std::vector<std::string> kinds_in(std::string_view list) {
  std::vector<std::string> kinds;
  for (const Extension& part : experiment_parts())
    if (part.parent == list) kinds.emplace_back(part.name);
  return kinds;
}

std::string either_of(const std::vector<std::string>& kinds) {
  std::string text;
  for (const std::string& kind : kinds) text += (text.empty() ? "" : ", ") + kind;
  return text;
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): assigning a YAML::Node may throw, and nothing here relies on it not to.
struct CourseReader::Written {
  YAML::Node node;   // the whole entry
  std::string path;  // of the kind, such as `events[0].add`
  std::string kind;
  YAML::Node map;  // of the kind's keys
  std::chrono::nanoseconds time{0};
};

struct CourseReader::ReadEvent {
  Event event;
  YAML::Node node;
  std::string path;
};

namespace {

/// The values of one entry and where they stand.
class Entry {
 public:
  Entry(const YAML::Node& map, std::string path, const Extension& part, const YamlReport& report)
      : map_(map), path_(std::move(path)), report_(report), values_(read_values(map, path_, part, true, report)) {}

  const KeyValues& values() const { return values_; }
  void problem(const std::string& key, std::string message) const {
    const YAML::Node& map = map_;
    const bool has_key = map.IsMap() && map[key];
    report_.problem(has_key ? map[key] : map, path_ + "." + key, std::move(message));
  }
  /// Of a key in seconds; nothing, and reported, if it is too long.
  std::optional<std::chrono::nanoseconds> time(const std::string& key) const {
    if (!values_.has(key)) return std::nullopt;
    const std::optional<std::chrono::nanoseconds> time = to_time(values_.real(key));
    if (!time) problem(key, "expected at most 9e9 s");
    return time;
  }
  /// The objects that the key `objects` selects, ascending; what selects none is reported.
  std::vector<std::size_t> objects(const World& world) const {
    std::vector<std::size_t> selected;
    for (const std::string& selector : values_.texts("objects")) {
      try {
        const std::vector<std::size_t> found = select_objects(world, selector);
        selected.insert(selected.end(), found.begin(), found.end());
      } catch (const std::invalid_argument& error) {
        problem("objects", error.what());
      }
    }
    std::sort(selected.begin(), selected.end());
    selected.erase(std::unique(selected.begin(), selected.end()), selected.end());
    return selected;
  }

 private:
  YAML::Node map_;
  std::string path_;
  const YamlReport& report_;
  KeyValues values_;
};

/// What an event of some kind does to one object; nothing, and reported, if it cannot be.
using ReadAction = std::optional<Action> (*)(const Entry& entry, const World& world, std::size_t object);

std::optional<Action> read_coming(const Entry&, const World&, std::size_t) { return SetPresence{true}; }
std::optional<Action> read_leaving(const Entry&, const World&, std::size_t) { return SetPresence{false}; }

std::optional<Action> read_move(const Entry& entry, const World&, std::size_t) {
  if (!entry.values().has("pose")) return std::nullopt;
  return PlaceAt{entry.values().pose("pose")};
}

// False, and reported, of what stays where it is.
bool can_be_pushed(const Entry& entry, const World& world, std::size_t object) {
  const Model& model = world.models[world.instances[object].model];
  const auto ties_root = [](const Joint& joint) { return joint.parent == Joint::world && joint.child == 0; };
  const bool is_tied = std::any_of(model.joints.begin(), model.joints.end(), ties_root);
  if (!model.is_static && !is_tied) return true;
  entry.problem("objects", "'" + world.instances[object].name + "' " +
                               (model.is_static ? "is static" : "is tied to the world by a joint"));
  return false;
}

std::optional<Action> read_set_velocity(const Entry& entry, const World& world, std::size_t object) {
  const KeyValues& values = entry.values();
  if (!values.has("linear") || !values.has("angular") || !can_be_pushed(entry, world, object)) return std::nullopt;
  return SetVelocity{values.vector("linear"), values.vector("angular")};
}

std::optional<Action> read_apply_force(const Entry& entry, const World& world, std::size_t object) {
  const KeyValues& values = entry.values();
  const std::optional<std::chrono::nanoseconds> duration = entry.time("for");
  const Model& model = world.models[world.instances[object].model];
  if (!values.has("force") || !values.has("torque") || !duration) return std::nullopt;
  if (model.is_static) {
    entry.problem("objects", "'" + world.instances[object].name + "' is static");
    return std::nullopt;
  }
  std::size_t link = 0;
  if (values.has("link")) {
    std::vector<std::string> names;
    for (const Link& each : model.links) names.push_back(each.name);
    link = static_cast<std::size_t>(std::find(names.begin(), names.end(), values.text("link")) - names.begin());
    if (link == names.size()) {
      entry.problem("link", "'" + world.instances[object].name + "' has no link '" + values.text("link") + "'" +
                                suggestion(values.text("link"), names));
      return std::nullopt;
    }
  }
  return ApplyForce{link, values.vector("force"), values.vector("torque"), *duration};
}

// A new kind of event: its keys in experiment_keys.cpp, a line here, and what it does in the simulation.
constexpr std::pair<std::string_view, ReadAction> actions[] = {
    {"add", &read_coming},
    {"remove", &read_leaving},
    {"disable", &read_leaving},
    {"enable", &read_coming},
    {"move", &read_move},
    {"set_velocity", &read_set_velocity},
    {"apply_force", &read_apply_force},
};

using Condition = decltype(StopCondition::what);
using ReadCondition = std::optional<Condition> (*)(const Entry& entry);

std::optional<Condition> read_inside(const Entry& entry) {
  const KeyValues& values = entry.values();
  if (!values.has("min") || !values.has("max")) return std::nullopt;
  if ((values.point("min").array() > values.point("max").array()).any()) entry.problem("min", "exceeds max");
  return AllInside{values.point("min"), values.point("max")};
}
std::optional<Condition> read_beyond(const Entry& entry) {
  const KeyValues& values = entry.values();
  if (!values.has("point") || !values.has("direction")) return std::nullopt;
  if (values.point("direction").isZero()) entry.problem("direction", "expected a direction that is not zero");
  return OneBeyond{values.point("point"), values.point("direction")};
}
std::optional<Condition> read_at_rest(const Entry& entry) {
  const KeyValues& values = entry.values();
  if (!values.has("speed") || !values.has("turn_rate")) return std::nullopt;
  return AllAtRest{values.real("speed"), values.real("turn_rate")};
}
std::optional<Condition> read_quarantined(const Entry&) { return OneQuarantined{}; }

constexpr std::pair<std::string_view, ReadCondition> conditions[] = {
    {"inside", &read_inside}, {"beyond", &read_beyond}, {"at_rest", &read_at_rest}, {"quarantined", &read_quarantined}};

constexpr std::pair<std::string_view, Quantity> quantities[] = {
    {"position", Quantity::position}, {"pose", Quantity::pose},   {"heading", Quantity::heading},
    {"velocity", Quantity::velocity}, {"count", Quantity::count}, {"quarantined", Quantity::quarantined}};

template <class Named>
auto named(const Named& entries, std::string_view name) {
  const auto* const found =
      std::find_if(std::begin(entries), std::end(entries), [&](const auto& entry) { return entry.first == name; });
  if (found == std::end(entries)) throw std::logic_error("nothing reads " + std::string(name));
  return found->second;
}

}  // namespace

void CourseReader::choose_kind(const YamlMap& map, const std::vector<std::string>& kinds, Written& written) {
  for (const std::string& kind : kinds) {
    if (!map.has(kind)) continue;
    if (!written.kind.empty()) {
      map.problem(kind, "is a second one; every entry of the list has one");
      continue;
    }
    written.kind = kind;
    written.map = map.where(kind);
    written.path = map.path_to(kind);
  }
}

std::vector<CourseReader::Written> CourseReader::entries(const std::string& list, bool have_times) const {
  std::vector<Written> found;
  if (!top_.has(list)) return found;
  const YAML::Node nodes = top_.where(list);
  if (!nodes.IsSequence()) {
    top_.problem(list, "expected a list, not " + shown(nodes));
    return found;
  }
  const std::vector<std::string> kinds = kinds_in(list);
  std::vector<std::string> known = kinds;
  if (have_times) known.insert(known.begin(), "at");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string path = list + "[" + std::to_string(i) + "]";
    const YamlMap map(nodes[i], path, known, report_);
    if (!nodes[i].IsMap()) continue;
    Written written{nodes[i], path, "", {}, {}};
    if (have_times) {
      map.require("at", "when it happens, in seconds of simulated time");
      if (const std::optional<double> seconds = map.real("at")) {
        const std::optional<std::chrono::nanoseconds> time = to_time(*seconds);
        if (!time) map.problem("at", "expected from 0 s to 9e9 s");
        written.time = time.value_or(written.time);
      }
    }
    choose_kind(map, kinds, written);
    if (!written.kind.empty())
      found.push_back(written);
    else if (std::all_of(nodes[i].begin(), nodes[i].end(),
                         [&](const auto& entry) { return entry.first.IsScalar() && entry.first.Scalar() == "at"; }))
      report_.problem(nodes[i], path, "missing: one of " + either_of(kinds));
  }
  return found;
}

std::vector<LaterObject> CourseReader::later_objects() const {
  // What is wrong is reported when all of it is read.
  std::vector<Problem> ignored;
  std::vector<LaterObject> objects;
  if (!top_.has("events") || !top_.where("events").IsSequence()) return objects;
  const YAML::Node nodes = top_.where("events");
  const YamlReport nothing(file_, ignored);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const YAML::Node& node = nodes[i];
    if (!node.IsMap() || !node["add"] || !node["add"].IsMap()) continue;
    const std::string path = "events[" + std::to_string(i) + "].add";
    const KeyValues values = read_values(node["add"], path, experiment_part("add", "events"), true, nothing);
    if (!values.has("model") || !values.has("name") || !values.has("pose")) continue;
    objects.push_back({values.text("model"),
                       values.text("name"),
                       values.pose("pose"),
                       {file_, node["add"].Mark().line + 1, path, ""}});
  }
  return objects;
}

void CourseReader::read(Experiment& experiment) const {
  read_events(experiment);
  read_stops(experiment);
  read_prints(experiment);
  read_history(experiment);
}

void CourseReader::read_events(Experiment& experiment) const {
  std::vector<ReadEvent> events;
  for (const Written& written : entries("events", true)) read_event(written, experiment.world, events);
  std::stable_sort(events.begin(), events.end(),
                   [](const ReadEvent& a, const ReadEvent& b) { return a.event.time < b.event.time; });
  check_order(experiment.world, events);
  for (ReadEvent& each : events) experiment.events.push_back(std::move(each.event));
}

void CourseReader::read_event(const Written& written, const World& world, std::vector<ReadEvent>& events) const {
  const Entry entry(written.map, written.path, experiment_part(written.kind, "events"), report_);
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
  for (const std::size_t object : objects)
    if (const std::optional<Action> action = named(actions, written.kind)(entry, world, object))
      events.push_back({{written.time, object, *action, written.kind}, written.map, written.path});
}

// What has been removed does not come back, and what has not come yet cannot be acted on.
void CourseReader::check_order(const World& world, const std::vector<ReadEvent>& events) const {
  std::vector<char> is_there(world.instances.size());
  std::vector<char> is_gone(world.instances.size(), 0);
  for (std::size_t i = 0; i < world.instances.size(); ++i) is_there[i] = world.instances[i].is_present ? 1 : 0;
  for (const ReadEvent& each : events) {
    const Event& event = each.event;
    const std::string name = "'" + world.instances[event.object].name + "'";
    if (is_gone[event.object])
      report_.problem(each.node, each.path, name + " has been removed by then");
    else if (event.kind != "add" && !is_there[event.object])
      report_.problem(each.node, each.path, name + " has not been added by then");
    if (event.kind == "add") is_there[event.object] = 1;
    if (event.kind == "remove" && is_there[event.object]) is_gone[event.object] = 1;
  }
}

void CourseReader::read_stops(Experiment& experiment) const {
  for (const Written& written : entries("stop", false)) {
    const Entry entry(written.map, written.path, experiment_part(written.kind, "stop"), report_);
    StopCondition condition{written.kind, entry.objects(experiment.world), OneQuarantined{},
                            entry.time("for").value_or(std::chrono::nanoseconds(0))};
    if (const auto what = named(conditions, written.kind)(entry)) {
      condition.what = *what;
      experiment.stops.push_back(std::move(condition));
    }
  }
}

void CourseReader::read_prints(Experiment& experiment) const {
  if (!top_.has("print")) return;
  const YAML::Node nodes = top_.where("print");
  if (!nodes.IsSequence()) return top_.problem("print", "expected a list, not " + shown(nodes));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Entry entry(nodes[i], "print[" + std::to_string(i) + "]", experiment_part("print", "experiment"), report_);
    const KeyValues& values = entry.values();
    const std::optional<std::chrono::nanoseconds> every = entry.time("every");
    PrintedQuantity printed;
    for (const std::string& selector : values.texts("objects"))
      printed.selector += (printed.selector.empty() ? "" : " ") + selector;
    printed.objects = entry.objects(experiment.world);
    if (!values.has("quantity") || !every) continue;
    printed.quantity = named(quantities, values.text("quantity"));
    printed.every = *every;
    experiment.prints.push_back(std::move(printed));
  }
}

void CourseReader::read_history(Experiment& experiment) const {
  if (!top_.has("history")) return;
  const Entry entry(top_.where("history"), "history", experiment_part("history", "experiment"), report_);
  experiment.history.objects = entry.objects(experiment.world);
  if (entry.values().has("length"))
    experiment.history.length = static_cast<std::size_t>(entry.values().whole("length"));
  experiment.history.every = entry.time("every").value_or(std::chrono::nanoseconds(0));
}

}  // namespace cohort::description
