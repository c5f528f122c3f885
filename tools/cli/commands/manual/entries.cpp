// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/manual/entries.hpp"

#include <algorithm>

#include "server/parsing/keys/experiment_keys.hpp"

namespace cohort::tool {
namespace {

constexpr Topic all_topics[] = {
    {"sensors", "sensors of robots"},
    {"actuators", "actuators of robots"},
    {"emitters", "sources of light, sound and other signals that sensors detect"},
    {"physics", "simulation settings and materials"},
    {"placement", "populations of robots and objects, and their placement"},
    {"experiment", "world, duration, seed and teams"},
    {"events", "changes of the world at given times or when a robot performs an action"},
    {"stop", "conditions that end a run early"},
    {"print", "quantities that a run prints"},
    {"history", "objects whose most recent poses are kept"},
    {"record", "contents of recordings"},
    {"ros2", "ROS 2 interface of the robots"},
    {"values", "notation of numbers, poses and names"},
    {"samples", "files with measured or computed sensor readings"},
    {"selectors", "selection of robots and objects"},
};

}  // namespace

std::span<const Topic> topics() { return all_topics; }

const std::vector<const parsing::Extension*>& manual_entries() {
  static const std::vector<const parsing::Extension*> entries = [] {
    std::vector<const parsing::Extension*> all;
    for (const parsing::Extension& extension : parsing::extensions()) all.push_back(&extension);
    for (const parsing::Extension& part : parsing::experiment_parts()) all.push_back(&part);
    return all;
  }();
  return entries;
}

std::vector<const parsing::Extension*> entries_of(std::string_view topic) {
  std::vector<const parsing::Extension*> found;
  std::ranges::copy_if(manual_entries(), std::back_inserter(found),
                       [&](const parsing::Extension* entry) { return entry->topic == topic; });
  return found;
}

bool is_of_experiments(const parsing::Extension& entry) {
  return std::ranges::any_of(parsing::experiment_parts(), [&](const auto& part) { return &part == &entry; });
}

std::string parent_of(const parsing::Extension& entry) {
  const bool is_ours = std::ranges::any_of(parsing::extensions(),
                                           [&](const parsing::Extension& each) { return each.name == entry.parent; });
  return is_ours && !is_of_experiments(entry) ? parsing::prefixed(entry.parent) : std::string(entry.parent);
}

}  // namespace cohort::tool
