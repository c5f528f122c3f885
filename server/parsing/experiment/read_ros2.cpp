// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/experiment/read_ros2.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "server/core/text.hpp"
#include "server/description/select_robots.hpp"
#include "server/parsing/experiment/schedule_entry.hpp"
#include "server/parsing/keys/choices.hpp"
#include "server/parsing/keys/experiment_keys.hpp"

namespace cohort::parsing {
namespace {

// Returns whether ROS accepts a relative name: parts of letters, digits and underscores, with a slash between them
// (design.ros2.org/articles/topic_and_service_names.html). `wildcard` matches any characters; 0 for none.
bool is_relative_ros_name(std::string_view name, char wildcard = 0) {
  const auto is_letter = [&](char c) {
    return c == '_' || (c != 0 && c == wildcard) || std::isalpha(static_cast<unsigned char>(c)) != 0;
  };
  if (name.empty() || name.find("__") != std::string_view::npos) return false;
  char before = '/';
  for (const char c : name) {
    const bool is_digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (before == '/' ? !is_letter(c) : !is_letter(c) && !is_digit && c != '/') return false;
    before = c;
  }
  return before != '/';
}

bool is_ros_name(std::string_view name) { return is_relative_ros_name(name.starts_with('/') ? name.substr(1) : name); }

bool is_frame(std::string_view name) {
  return !name.starts_with('/') && name.find_first_of(" \t") == std::string_view::npos;
}

class Ros2Reader {
 public:
  Ros2Reader(const World* world, const std::vector<Team>& teams, const YamlReport& report)
      : world_(world), teams_(teams), report_(report) {}

  Ros2 read(const YamlNode& node) const;

 private:
  void read_teams_of(const YamlNode& node, Ros2& ros2) const;
  void read_settings(const ScheduleEntry& entry, const YamlNode& node, const std::string& path,
                     Ros2Settings& settings) const;
  void read_sync(const ScheduleEntry& entry, Ros2Settings& settings) const;
  void read_names(const ScheduleEntry& entry, Ros2Settings& settings) const;
  void read_topics(const YamlNode& node, const std::string& path, std::vector<Ros2Topic>& topics) const;
  std::optional<Ros2Topic> read_topic(const YamlNode& key, const YamlNode& value, const std::string& path) const;
  std::optional<Ros2Drive> read_drive(const YamlNode& node, const std::string& path) const;
  void select(const ScheduleEntry& entry, Ros2& ros2) const;
  void check_namespaces(const YamlNode& node, const Ros2& ros2) const;

  const World* world_;  // null: could not be read
  const std::vector<Team>& teams_;
  const YamlReport& report_;
};

Ros2 Ros2Reader::read(const YamlNode& node) const {
  constexpr std::uint64_t last_domain = 232;  // beyond, DDS has no ports
  Ros2 ros2;
  const ScheduleEntry entry(node, "ros2", experiment_part("ros2", "experiment"), report_, Fallbacks::left_out);
  if (!node.is_map()) return ros2;
  if (entry.values().has("domain")) {
    const std::uint64_t domain = entry.values().whole("domain");
    if (domain > last_domain) entry.problem("domain", "expected at most " + std::to_string(last_domain));
    ros2.domain = static_cast<std::uint32_t>(domain);
  }
  select(entry, ros2);
  read_settings(entry, node, "ros2", ros2.common);
  if (const YamlNode* const teams = node.find("teams")) read_teams_of(*teams, ros2);
  check_namespaces(node, ros2);
  return ros2;
}

void Ros2Reader::read_teams_of(const YamlNode& node, Ros2& ros2) const {
  std::vector<std::string> names;
  for (const Team& team : teams_) names.push_back(team.name);
  if (!node.is_map()) return report_.problem(node, "ros2.teams", "expected 'TEAM: SETTINGS' lines, not " + shown(node));
  for (const auto& [key, value] : node.pairs) {
    const std::string path = "ros2.teams." + key->text;
    if (!names.empty() && std::ranges::find(names, key->text) == names.end()) {
      report_.problem(*key, path, "there is no team '" + key->text + "'" + suggestion(key->text, names));
      continue;
    }
    Ros2Settings settings = ros2.common;
    read_settings({*value, path, experiment_part("teams", "ros2"), report_, Fallbacks::left_out}, *value, path,
                  settings);
    if (!ros2.teams.emplace(key->text, std::move(settings)).second)
      report_.problem(*key, path, "the team is given twice");
  }
}

void Ros2Reader::read_settings(const ScheduleEntry& entry, const YamlNode& node, const std::string& path,
                               Ros2Settings& settings) const {
  read_sync(entry, settings);
  read_names(entry, settings);
  if (entry.values().has("odometry"))
    settings.odometry = choice_of<RosOdometry>(ros_odometries, entry.values().text("odometry"));
  if (const YamlNode* const topics = node.find("topics")) read_topics(*topics, path + ".topics", settings.topics);
  if (const YamlNode* const drive = node.find("drive")) settings.drive = read_drive(*drive, path + ".drive");
}

void Ros2Reader::read_sync(const ScheduleEntry& entry, Ros2Settings& settings) const {
  if (entry.values().has("sync")) settings.sync = choice_of<RosSync>(ros_syncs, entry.values().text("sync"));
  if (entry.values().has("on_silence"))
    settings.on_silence = choice_of<RosOnSilence>(ros_silences, entry.values().text("on_silence"));
  if (entry.values().has("wait")) settings.wait = entry.time("wait");
  if (entry.values().has("reply_to")) settings.reply_to = entry.values().text("reply_to");
  // Without `sync`, these keys may be meant for teams that have one.
  if (settings.sync == RosSync::free && entry.is_written("sync")) {
    for (const char* const key : {"wait", "on_silence"})
      if (entry.is_written(key)) entry.problem(key, "cannot be used with sync: free, which never waits");
  } else if (settings.on_silence != RosOnSilence::wait && !settings.wait && !entry.is_written("wait")) {
    entry.problem("on_silence", "requires `wait`, the time after which it applies");
  }
}

void Ros2Reader::read_names(const ScheduleEntry& entry, Ros2Settings& settings) const {
  if (entry.values().has("namespace")) {
    const std::string& name = entry.values().text("namespace");
    if (name != "/" && (!name.starts_with('/') || !is_ros_name(name)))
      entry.problem(
          "namespace",
          "expected '/', or names of letters, digits and underscores, each preceded by a slash, not '" + name + "'");
    settings.name_space = name;
  }
  const auto take_frame = [&](const char* key, std::string& frame) {
    if (!entry.values().has(key)) return;
    frame = entry.values().text(key);
    if (!is_frame(frame))
      entry.problem(key, "expected a frame name without spaces and without a leading slash, not '" + frame + "'");
  };
  take_frame("frames", settings.frames);
  take_frame("base_frame", settings.base_frame);
}

void Ros2Reader::read_topics(const YamlNode& node, const std::string& path, std::vector<Ros2Topic>& topics) const {
  if (!node.is_map()) return report_.problem(node, path, "expected 'TOPIC: …' lines, not " + shown(node));
  std::vector<std::string> seen;
  for (const auto& [key, value] : node.pairs) {
    const std::string path_to_it = path + "." + key->text;
    if (!is_relative_ros_name(key->text, '*')) {
      report_.problem(*key, path_to_it, "expected a topic of a robot, such as scan or range/*, not " + shown(*key));
      continue;
    }
    if (std::ranges::find(seen, key->text) != seen.end()) report_.problem(*key, path_to_it, "the topic is given twice");
    seen.push_back(key->text);
    if (auto topic = read_topic(*key, *value, path_to_it)) topics.push_back(*std::move(topic));
  }
}

std::optional<Ros2Topic> Ros2Reader::read_topic(const YamlNode& key, const YamlNode& value,
                                                const std::string& path) const {
  Ros2Topic topic{.topic = key.text, .is_published = true, .name = {}, .rate = {}, .line = key.line};
  if (value.is_scalar() && value.text == "false") {
    topic.is_published = false;
    return topic;
  }
  if (!value.is_map()) {
    report_.problem(value, path, "expected false, or a map with name or rate, not " + shown(value));
    return std::nullopt;
  }
  const ScheduleEntry entry(value, path, experiment_part("topics", "ros2"), report_);
  if (entry.values().has("rate")) topic.rate = entry.values().real("rate");
  if (!entry.values().has("name")) return topic;
  topic.name = entry.values().text("name");
  if (topic.topic.find('*') != std::string::npos)
    entry.problem("name", "'" + topic.topic + "' can match several topics, which cannot share a name");
  else if (!is_ros_name(topic.name))
    entry.problem("name",
                  "expected names of letters, digits and underscores, separated by slashes, not '" + topic.name + "'");
  return topic;
}

std::optional<Ros2Drive> Ros2Reader::read_drive(const YamlNode& node, const std::string& path) const {
  const ScheduleEntry entry(node, path, experiment_part("drive", "ros2"), report_);
  const KeyValues& values = entry.values();
  for (const char* const key : {"left", "right", "wheel_radius", "wheel_separation"})
    if (!values.has(key)) return std::nullopt;  // and reported
  return Ros2Drive{values.texts("left"), values.texts("right"), values.real("wheel_radius"),
                   values.real("wheel_separation"), node.line};
}

void Ros2Reader::select(const ScheduleEntry& entry, Ros2& ros2) const {
  if (!entry.values().has("robots")) return;
  ros2.robots = entry.values().texts("robots");
  if (world_ == nullptr) return;
  try {
    select_robots(*world_, ros2.robots);
  } catch (const std::invalid_argument& error) {
    entry.problem("robots", error.what());
  }
}

// Two robots with the same namespace would share their topics.
void Ros2Reader::check_namespaces(const YamlNode& node, const Ros2& ros2) const {
  if (world_ == nullptr) return;
  const std::vector<std::uint32_t> seen = select_robots_of_any(*world_, ros2.robots);
  std::map<std::string, std::string> robot_of;  // by namespace
  for (const Team& team : teams_) {
    const std::string& name = ros2.of_team(team.name).name_space;
    if (name.empty()) continue;
    for (const std::uint32_t robot : team.robots) {
      if (!std::ranges::binary_search(seen, robot)) continue;
      const auto [other, is_first] = robot_of.emplace(name, world_->robot(robot).name);
      if (is_first) continue;
      const YamlNode* own = node.find("teams");
      own = own == nullptr ? nullptr : own->find(team.name);
      const bool is_own = own != nullptr && own->find("namespace") != nullptr;
      const std::string path = is_own ? "ros2.teams." + team.name + ".namespace" : "ros2.namespace";
      return report_.problem(*(is_own ? own : &node)->find("namespace"), path,
                             "must belong to a single robot, but is used by '" + other->second + "' and '" +
                                 world_->robot(robot).name + "'");
    }
  }
}

}  // namespace

Ros2 read_ros2(const YamlMap& top, const World* world, const std::vector<Team>& teams, const YamlReport& report) {
  if (!top.has("ros2")) return {};
  return Ros2Reader(world, teams, report).read(top.where("ros2"));
}

}  // namespace cohort::parsing
