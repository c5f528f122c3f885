// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/experiment/read_teams.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "server/core/text.hpp"
#include "server/description/select_robots.hpp"
#include "server/parsing/keys/choices.hpp"
#include "server/parsing/keys/experiment_keys.hpp"

namespace cohort::parsing {
namespace {

constexpr std::uint64_t greatest_tick_count = std::numeric_limits<std::uint32_t>::max();

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
  // Returns false if the key is present with an invalid value.
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
    team.problem("delay", "cannot be used with mode: free, in which commands take effect on arrival");
  policy.required = read_required(team, !is_free);

  const std::string on_late = team.text("on_late").value_or(is_free ? "hold" : "wait");
  if (std::ranges::find(late_policies, on_late) == std::end(late_policies)) {
    team.problem("on_late", "unknown policy '" + on_late + "'" +
                                suggestion(on_late, {std::begin(late_policies), std::end(late_policies)}));
    return policy;
  }
  policy.on_late = choice_of<OnLate>(late_policies, on_late);
  if (policy.on_late == OnLate::wait) {
    if (is_free) team.problem("on_late", "'wait' cannot be used with mode: free; expected hold, zero, detach or stop");
    if (team.has("deadline"))
      team.problem("deadline", "cannot be used with on_late: wait, which waits without a time limit");
    return policy;
  }
  if (is_free && policy.on_late == OnLate::hold) {
    if (team.has("deadline"))
      team.problem("deadline", "cannot be used with mode: free and on_late: hold, which has no time limit");
    return policy;
  }
  team.require("deadline", "wall time to wait for an answer before '" + on_late + "', in seconds");
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
                 "'rewind' requires on_late: wait; with other policies the results depend on the wall clock, "
                 "so a repeated run may differ");
  return OnLost::rewind;
}

Restart read_restart(const YamlMap& team) {
  const std::string restart = team.text("restart").value_or("on_failure");
  if (restart == "never") return Restart::never;
  if (restart != "on_failure")
    team.problem("restart", "unknown value '" + restart + "'" + suggestion(restart, {"on_failure", "never"}));
  return Restart::on_failure;
}

class TeamReader {
 public:
  TeamReader(const World* world, const YamlReport& report)
      : world_(world), report_(report), team_of_(world == nullptr ? 0 : world->robots.size()) {}

  std::vector<Team> read(const YamlMap& top);

 private:
  void read_team(const YamlNode& node, const std::string& path);
  void read_parameters(const YamlNode& map, const std::string& path, const std::string& prefix,
                       std::vector<Parameter>& parameters);
  void select(const YamlNode& selector, const std::string& path, std::set<std::uint32_t>& selected);
  void claim(const YamlNode& node, const std::string& path, const std::string& team,
             const std::set<std::uint32_t>& selected);
  void report_robots_without_team(const YamlMap& top);
  std::string listed(const std::vector<std::uint32_t>& robots) const;

  const World* world_;  // null: could not be read
  const YamlReport& report_;
  std::vector<Team> teams_;
  bool selectors_are_right_ = true;
  std::vector<std::string> team_of_;  // by robot; empty if none
};

std::vector<Team> TeamReader::read(const YamlMap& top) {
  if (!top.has("teams")) return {};
  const YamlNode& teams = top.where("teams");
  if (!teams.is_list()) {
    top.problem("teams", "expected a list of teams, not " + shown(teams));
    return {};
  }
  for (std::size_t i = 0; i < teams.items.size(); ++i) read_team(*teams.items[i], "teams[" + std::to_string(i) + "]");
  // A missing or misspelt selector leaves robots without a team.
  if (selectors_are_right_) report_robots_without_team(top);
  return std::move(teams_);
}

void TeamReader::read_team(const YamlNode& node, const std::string& path) {
  const YamlMap map(node, path, names_of_keys(experiment_part("teams", "experiment")), report_);
  map.require("name", "a name for the team");
  map.require("robots", "robots of the team");
  map.require("controller", "name of a controller, or path to a controller plugin");
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
  for (const Team& other : teams_)
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
  teams_.push_back(std::move(team));
}

// Reads parameters, whose meaning only the controller knows. Checks only their structure: maps of maps, of values, and
// of lists of values.
void TeamReader::read_parameters(const YamlNode& map, const std::string& path, const std::string& prefix,
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
                          (value->is_list() ? "a list that contains lists or maps" : shown(*value)));
    } else if (std::ranges::any_of(parameters, [&](const Parameter& other) { return other.name == name; })) {
      report_.problem(*key, path_to_it, "the parameter is given twice");
    } else {
      parameters.push_back(std::move(parameter));
    }
  }
}

void TeamReader::select(const YamlNode& selector, const std::string& path, std::set<std::uint32_t>& selected) {
  if (!selector.is_scalar()) {
    report_.problem(selector, path,
                    "expected a robot's name, an id, a range 0..7, all, or a list of these, not " + shown(selector));
    return;
  }
  if (world_ == nullptr) return;
  try {
    for (const std::uint32_t robot : select_robots(*world_, selector.text)) selected.insert(robot);
  } catch (const std::invalid_argument& error) {
    report_.problem(selector, path, error.what());
    selectors_are_right_ = false;
  }
}

void TeamReader::claim(const YamlNode& node, const std::string& path, const std::string& team,
                       const std::set<std::uint32_t>& selected) {
  std::vector<std::uint32_t> taken;
  for (const std::uint32_t robot : selected) {
    if (team_of_[robot].empty())
      team_of_[robot] = team.empty() ? path : team;
    else
      taken.push_back(robot);
  }
  if (!taken.empty())
    report_.problem(node, path,
                    "robots that are already in another team: " + listed(taken) + " ('" + team_of_[taken[0]] + "')");
}

void TeamReader::report_robots_without_team(const YamlMap& top) {
  std::vector<std::uint32_t> without;
  for (std::uint32_t robot = 0; robot < team_of_.size(); ++robot)
    if (team_of_[robot].empty()) without.push_back(robot);
  if (!without.empty()) top.problem("teams", "robots that are not in any team: " + listed(without));
}

std::string TeamReader::listed(const std::vector<std::uint32_t>& robots) const {
  constexpr std::size_t most = 5;
  std::string names;
  for (std::size_t i = 0; i < std::min(robots.size(), most); ++i)
    names += (i == 0 ? "'" : ", '") + world_->robot(robots[i]).name + "'";
  return robots.size() <= most ? names : names + " and " + std::to_string(robots.size() - most) + " more";
}

}  // namespace

std::optional<std::chrono::nanoseconds> read_seconds(const YamlMap& map, const std::string& key) {
  constexpr double longest = 9e9;  // 285 years
  const std::optional<double> seconds = map.real(key);
  if (!seconds) return std::nullopt;
  const double nanoseconds = std::round(*seconds * 1e9);
  if (nanoseconds >= 1.0 && *seconds <= longest)
    return std::chrono::nanoseconds(static_cast<std::int64_t>(nanoseconds));
  map.problem(key, "expected a time > 0 s and <= 9e9 s");
  return std::nullopt;
}

std::vector<Team> read_teams(const YamlMap& top, const World* world, const YamlReport& report) {
  return TeamReader(world, report).read(top);
}

}  // namespace cohort::parsing
