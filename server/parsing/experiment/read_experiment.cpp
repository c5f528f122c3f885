#include "server/parsing/experiment/read_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "client_sdk/text/printable.hpp"
#include "server/core/text.hpp"
#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/description/select_robots.hpp"
#include "server/parsing/experiment/read_schedule.hpp"
#include "server/parsing/files/input_file.hpp"
#include "server/parsing/keys/choices.hpp"
#include "server/parsing/keys/experiment_keys.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/world/physics_settings.hpp"
#include "server/parsing/world/read_world.hpp"
#include "server/parsing/yaml/yaml_document.hpp"
#include "server/parsing/yaml/yaml_map.hpp"
#include "server/parsing/yaml/yaml_values.hpp"

namespace cohort::parsing {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_threads = 1024;
constexpr std::uint64_t greatest_tick_count = std::numeric_limits<std::uint32_t>::max();

// A time that is more than nothing and fits into nanoseconds.
std::optional<std::chrono::nanoseconds> read_seconds(const YamlMap& map, const std::string& key) {
  constexpr double longest = 9e9;  // 285 years
  const std::optional<double> seconds = map.real(key);
  if (!seconds) return std::nullopt;
  const double nanoseconds = std::round(*seconds * 1e9);
  if (nanoseconds >= 1.0 && *seconds <= longest)
    return std::chrono::nanoseconds(static_cast<std::int64_t>(nanoseconds));
  map.problem(key, "expected more than 0 s and at most 9e9 s");
  return std::nullopt;
}

Mode read_mode(const YamlMap& team) {
  const std::string mode = team.text("mode").value_or("lockstep");
  if (mode == "free") return Mode::free;
  if (mode != "lockstep") team.problem("mode", "unknown mode '" + mode + "'" + suggestion(mode, {"lockstep", "free"}));
  return Mode::lockstep;
}

bool read_required(const YamlMap& team, bool if_absent) {
  const std::string required = team.text("required").value_or(if_absent ? "true" : "false");
  if (required != "true" && required != "false")
    team.problem("required", "expected true or false, not '" + required + "'");
  return required == "true";
}

Policy read_policy(const YamlMap& team) {
  Policy policy;
  // False if the key is there and its value is wrong.
  const auto ticks = [&](const char* key, std::uint64_t least, std::uint32_t& value) {
    const auto read = team.whole(key, least, greatest_tick_count);
    if (read) value = static_cast<std::uint32_t>(*read);
    return read || !team.has(key);
  };
  const bool period_is_right = ticks("period", 1, policy.period);
  ticks("phase", 0, policy.phase);
  ticks("delay", 0, policy.delay);
  if (period_is_right && policy.phase >= policy.period)
    team.problem("phase", "expected less than the period, " + std::to_string(policy.period));

  policy.mode = read_mode(team);
  const bool is_free = policy.mode == Mode::free;
  if (is_free && policy.delay != 0)
    team.problem("delay", "has no meaning with mode: free, whose answers act as they come");
  policy.required = read_required(team, !is_free);

  const std::string on_late = team.text("on_late").value_or(is_free ? "hold" : "wait");
  if (std::ranges::find(late_policies, on_late) == std::end(late_policies)) {
    team.problem("on_late", "unknown policy '" + on_late + "'" +
                                suggestion(on_late, {std::begin(late_policies), std::end(late_policies)}));
    return policy;
  }
  policy.on_late = choice_of<OnLate>(late_policies, on_late);
  if (policy.on_late == OnLate::wait) {
    if (is_free) team.problem("on_late", "nobody waits under mode: free; expected hold, zero, detach or stop");
    if (team.has("deadline")) team.problem("deadline", "has no meaning with on_late: wait, which waits for ever");
    return policy;
  }
  if (is_free && policy.on_late == OnLate::hold) {
    if (team.has("deadline"))
      team.problem("deadline", "has no meaning with mode: free, which holds the last command anyway");
    return policy;
  }
  team.require("deadline", "how long to wait before '" + on_late + "', in seconds");
  policy.deadline = read_seconds(team, "deadline").value_or(policy.deadline);
  return policy;
}

OnLost read_on_lost(const YamlMap& team, const Policy& policy) {
  const std::string on_lost = team.text("on_lost").value_or("go_on");
  if (on_lost != "rewind") {
    if (on_lost != "go_on")
      team.problem("on_lost", "unknown value '" + on_lost + "'" + suggestion(on_lost, {"go_on", "rewind"}));
    return OnLost::go_on;
  }
  if (policy.on_late != OnLate::wait)
    team.problem("on_lost",
                 "'rewind' needs on_late: wait; the wall clock decides under other policies, so a run that "
                 "is repeated may be another one");
  return OnLost::rewind;
}

Restart read_restart(const YamlMap& team) {
  const std::string restart = team.text("restart").value_or("on_failure");
  if (restart == "never") return Restart::never;
  if (restart != "on_failure")
    team.problem("restart", "unknown value '" + restart + "'" + suggestion(restart, {"on_failure", "never"}));
  return Restart::on_failure;
}

class ExperimentReader {
 public:
  /// `input` must outlive this.
  ExperimentReader(InputFiles& input, const fs::path& file, const std::vector<fs::path>& last_model_folders)
      : input_(input), last_model_folders_(last_model_folders), report_(file, problems_) {
    experiment_.file = file;
  }

  Experiment read(std::optional<std::uint64_t> seed, std::optional<std::chrono::nanoseconds> duration);

 private:
  Experiment read_without_experiment(std::optional<std::uint64_t> seed,
                                     std::optional<std::chrono::nanoseconds> duration);
  YamlPtr load();
  void read_world_of(const YamlMap& top, const std::vector<LaterObject>& later);
  void read_step(const YamlMap& top);
  void read_teams(const YamlMap& top);
  void read_team(const YamlNode& node, const std::string& path);
  void read_parameters(const YamlNode& map, const std::string& path, const std::string& prefix,
                       std::vector<Parameter>& parameters);
  void select(const YamlNode& selector, const std::string& path, std::set<std::uint32_t>& selected);
  void claim(const YamlNode& node, const std::string& path, const std::string& team,
             const std::set<std::uint32_t>& selected);
  void report_robots_without_team(const YamlMap& top);
  std::string listed(const std::vector<std::uint32_t>& robots) const;

  InputFiles& input_;
  std::vector<fs::path> last_model_folders_;
  Experiment experiment_;
  std::vector<Problem> problems_;
  YamlReport report_;
  bool world_is_read_ = false;
  bool selectors_are_right_ = true;
  std::vector<std::string> team_of_;  // by robot; empty if none
};

Experiment ExperimentReader::read(std::optional<std::uint64_t> seed, std::optional<std::chrono::nanoseconds> duration) {
  if (kind_of_file(input_, experiment_.file) == FileKind::sdf) return read_without_experiment(seed, duration);
  const YamlPtr document = load();
  const YamlMap top(*document, "", names_of_keys(experiment_part("experiment", "")), report_);
  experiment_.name = printable(experiment_.file.stem().string());

  const std::uint64_t written_seed =
      top.whole("seed", 0, std::numeric_limits<std::uint64_t>::max()).value_or(experiment_.seed);
  experiment_.seed = seed.value_or(written_seed);
  if (!duration) top.require("duration", "simulated time in seconds");
  experiment_.duration = duration.value_or(read_seconds(top, "duration").value_or(experiment_.duration));
  top.require("world", "the file of the world, relative to this file");
  top.require("teams", "which robots have which controller");
  const ScheduleReader schedule(top, experiment_.file, report_);
  read_world_of(top, schedule.later_objects());
  read_step(top);
  if (top.has("threads"))
    experiment_.threads = static_cast<unsigned>(top.whole("threads", 1, most_threads).value_or(1));
  if (top.has("physics"))
    experiment_.world.physics =
        with_values(experiment_.world.physics, read_physics_map(top.where("physics"), top.path_to("physics"), report_));
  read_teams(top);
  if (world_is_read_) schedule.read(experiment_);

  if (!problems_.empty()) throw InputError(std::move(problems_));
  return std::move(experiment_);
}

Experiment ExperimentReader::read_without_experiment(std::optional<std::uint64_t> seed,
                                                     std::optional<std::chrono::nanoseconds> duration) {
  if (auto reason = input_.why_unreadable(input_.absolute(experiment_.file)))  // as it is read, and kept
    throw InputError({{experiment_.file, 0, "", std::move(*reason)}});
  experiment_.name = printable(experiment_.file.stem().string());
  experiment_.seed = seed.value_or(experiment_.seed);
  experiment_.duration = duration.value_or(duration_without_experiment);
  experiment_.world = read_world_or_standing_model(input_, experiment_.file, experiment_.seed, last_model_folders_);
  if (experiment_.world.robots.empty()) return std::move(experiment_);
  Team team;
  team.name = "robots";
  for (std::uint32_t robot = 0; robot < experiment_.world.robots.size(); ++robot) team.robots.push_back(robot);
  team.policy.required = false;
  experiment_.teams.push_back(std::move(team));
  return std::move(experiment_);
}

YamlPtr ExperimentReader::load() {
  const fs::path& file = experiment_.file;
  if (auto reason = input_.why_unreadable(file)) throw InputError({{file, 0, "", std::move(*reason)}});
  const YamlDocument document = parse_yaml(input_.read(file));
  if (document.error) throw InputError({{file, document.error->line, "", document.error->message}});
  return document.root;
}

void ExperimentReader::read_world_of(const YamlMap& top, const std::vector<LaterObject>& later) {
  const std::optional<std::string> name = top.text("world");
  if (!name) return;
  const fs::path world = (experiment_.file.parent_path() / *name).lexically_normal();
  if (const auto reason = input_.why_unreadable(world)) {
    top.problem("world", *reason + ": '" + world.string() + "'");
    return;
  }
  try {
    experiment_.world = read_world(input_, world, experiment_.seed, last_model_folders_, later);
    team_of_.resize(experiment_.world.robots.size());
    world_is_read_ = true;
  } catch (const InputError& error) {
    problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
  }
}

void ExperimentReader::read_step(const YamlMap& top) {
  constexpr std::chrono::nanoseconds longest = std::chrono::seconds(1);
  constexpr double rounding = 1e-3;  // of a nanosecond: 1/100 s has no exact binary number
  const std::optional<std::chrono::nanoseconds> step = read_seconds(top, "step");
  if (!step) return;
  const double nanoseconds = *top.real("step") * 1e9;
  if (*step > longest || std::abs(nanoseconds - std::round(nanoseconds)) > rounding)
    top.problem("step", "expected a whole number of nanoseconds, at most 1 s");
  experiment_.world.step = *step;
}

void ExperimentReader::read_teams(const YamlMap& top) {
  if (!top.has("teams")) return;
  const YamlNode& teams = top.where("teams");
  if (!teams.is_list()) {
    top.problem("teams", "expected a list of teams, not " + shown(teams));
    return;
  }
  for (std::size_t i = 0; i < teams.items.size(); ++i) read_team(*teams.items[i], "teams[" + std::to_string(i) + "]");
  // A missing or misspelt selector leaves robots without a team.
  if (selectors_are_right_) report_robots_without_team(top);
}

void ExperimentReader::read_team(const YamlNode& node, const std::string& path) {
  const YamlMap map(node, path, names_of_keys(experiment_part("teams", "experiment")), report_);
  map.require("name", "a name for the team");
  map.require("robots", "which robots belong to it");
  map.require("controller", "a controller plugin: its name or a path to it");
  Team team;
  team.name = map.text("name").value_or("");
  team.controller = map.text("controller").value_or("");
  team.controller_line = map.where("controller").line;
  if (map.has("parameters")) {
    if (map.where("parameters").is_map())
      read_parameters(map.where("parameters"), map.path_to("parameters"), "", team.parameters);
    else
      map.problem("parameters", "expected 'NAME: VALUE' lines, not " + shown(map.where("parameters")));
  }
  team.policy = read_policy(map);
  team.policy.on_lost = read_on_lost(map, team.policy);
  team.restart = read_restart(map);
  for (const Team& other : experiment_.teams)
    if (!team.name.empty() && other.name == team.name)
      map.problem("name", "another team has the name '" + team.name + "'");

  if (map.has("robots")) {
    const YamlNode& robots = map.where("robots");
    std::set<std::uint32_t> selected;
    if (robots.is_list() && !robots.items.empty()) {
      for (std::size_t i = 0; i < robots.items.size(); ++i)
        select(*robots.items[i], map.path_to("robots") + "[" + std::to_string(i) + "]", selected);
    } else {
      select(robots, map.path_to("robots"), selected);
    }
    claim(robots, map.path_to("robots"), team.name, selected);
    team.robots.assign(selected.begin(), selected.end());
  } else {
    selectors_are_right_ = false;
  }
  experiment_.teams.push_back(std::move(team));
}

// The controller knows what they mean; here only their shape is looked at: maps of maps, of values, and of lists of
// values.
void ExperimentReader::read_parameters(const YamlNode& map, const std::string& path, const std::string& prefix,
                                       std::vector<Parameter>& parameters) {
  for (const auto& [key, value] : map.pairs) {
    if (!key->is_scalar()) {
      report_.problem(*key, path, "expected a name, not " + shown(*key));
      continue;
    }
    const std::string name = prefix + key->text;
    const std::string path_to_it = path + "." + key->text;
    if (value->is_map()) {
      read_parameters(*value, path_to_it, name + ".", parameters);
      continue;
    }
    Parameter parameter{name, {}, key->line};
    if (value->is_scalar()) parameter.values.push_back(value->text);
    bool is_right = value->is_scalar() || value->is_list();
    for (const YamlPtr& each : value->items) {
      is_right &= each->is_scalar();
      parameter.values.push_back(each->text);
    }
    if (!is_right) {
      report_.problem(*key, path_to_it,
                      "expected a value or a list of values, not " +
                          (value->is_list() ? "a list of something else" : shown(*value)));
    } else if (std::ranges::any_of(parameters, [&](const Parameter& other) { return other.name == name; })) {
      report_.problem(*key, path_to_it, "the parameter is given twice");
    } else {
      parameters.push_back(std::move(parameter));
    }
  }
}

void ExperimentReader::select(const YamlNode& selector, const std::string& path, std::set<std::uint32_t>& selected) {
  if (!selector.is_scalar()) {
    report_.problem(selector, path,
                    "expected a robot's name, an id, a range 0..7, all, or a list of these, not " + shown(selector));
    return;
  }
  if (!world_is_read_) return;
  try {
    for (const std::uint32_t robot : select_robots(experiment_.world, selector.text)) selected.insert(robot);
  } catch (const std::invalid_argument& error) {
    report_.problem(selector, path, error.what());
    selectors_are_right_ = false;
  }
}

void ExperimentReader::claim(const YamlNode& node, const std::string& path, const std::string& team,
                             const std::set<std::uint32_t>& selected) {
  std::vector<std::uint32_t> taken;
  for (const std::uint32_t robot : selected) {
    if (team_of_[robot].empty())
      team_of_[robot] = team.empty() ? path : team;
    else
      taken.push_back(robot);
  }
  if (!taken.empty())
    report_.problem(node, path, "already in another team: " + listed(taken) + " ('" + team_of_[taken[0]] + "')");
}

void ExperimentReader::report_robots_without_team(const YamlMap& top) {
  std::vector<std::uint32_t> without;
  for (std::uint32_t robot = 0; robot < team_of_.size(); ++robot)
    if (team_of_[robot].empty()) without.push_back(robot);
  if (!without.empty()) top.problem("teams", "in no team: " + listed(without));
}

std::string ExperimentReader::listed(const std::vector<std::uint32_t>& robots) const {
  constexpr std::size_t most = 5;
  std::string names;
  for (std::size_t i = 0; i < std::min(robots.size(), most); ++i)
    names += (i == 0 ? "'" : ", '") + experiment_.world.robot(robots[i]).name + "'";
  return robots.size() <= most ? names : names + " and " + std::to_string(robots.size() - most) + " more";
}

}  // namespace

Experiment read_experiment(const fs::path& named, std::optional<std::uint64_t> seed,
                           std::optional<std::chrono::nanoseconds> duration,
                           const std::vector<fs::path>& last_model_folders, Xacro xacro) {
  const fs::path file = without_links(named);
  InputFiles disk;
  disk.trust(file, last_model_folders);
  if (xacro == Xacro::run) expand_named(disk, file);
  Experiment experiment = ExperimentReader(disk, file, last_model_folders).read(seed, duration);
  KeptFiles kept = disk.kept();
  kept.experiment = file.string();
  for (const fs::path& folder : last_model_folders) kept.last_model_folders.push_back(folder.string());
  experiment.inputs = std::make_shared<const KeptFiles>(std::move(kept));
  return experiment;
}

Experiment read_experiment(std::shared_ptr<const KeptFiles> kept, std::optional<std::uint64_t> seed,
                           std::optional<std::chrono::nanoseconds> duration) {
  InputFiles input(kept);
  const std::vector<fs::path> last_model_folders(kept->last_model_folders.begin(), kept->last_model_folders.end());
  Experiment experiment = ExperimentReader(input, kept->experiment, last_model_folders).read(seed, duration);
  experiment.inputs = std::move(kept);
  return experiment;
}

}  // namespace cohort::parsing
