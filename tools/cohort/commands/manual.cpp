#include "tools/cohort/commands/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <regex>

#include "server/parsing/keys/experiment_keys.hpp"

namespace cohort::tool {
namespace {

using parsing::Extension;
using parsing::ExtensionKey;

struct Group {
  const char* name;
  const char* text;
};
constexpr Group groups[] = {
    {"sensors", "what a robot can measure"},
    {"actuators", "what a robot can do"},
    {"emitters", "what sensors perceive from afar"},
    {"physics", "how the world is simulated, and what it is made of"},
    {"placement", "populations and where they are put"},
    {"experiment", "world, duration, seed and teams"},
    {"events", "what happens in a run at a time"},
    {"stop", "when a run ends early"},
    {"print", "what a run prints"},
    {"history", "whose last poses are kept"},
    {"record", "what recordings hold"},
};

std::vector<const Extension*> all_entries() {
  std::vector<const Extension*> entries;
  for (const Extension& extension : parsing::extensions()) entries.push_back(&extension);
  for (const Extension& part : parsing::experiment_parts()) entries.push_back(&part);
  return entries;
}

bool is_of_experiments(const Extension& entry) {
  const auto parts = parsing::experiment_parts();
  return &entry >= parts.data() && &entry < parts.data() + parts.size();
}

bool is_extension(std::string_view name) {
  const auto all = parsing::extensions();
  return std::any_of(all.begin(), all.end(), [&](const Extension& each) { return each.name == name; });
}

// Without what only a browser needs.
std::string plain(std::string_view doc) {
  static const std::regex link(R"(\[([^\]]*)\]\([^)]*\))");
  std::string text = std::regex_replace(std::string(doc), link, "$1");
  std::erase(text, '`');
  return text;
}

std::string title_of(const Extension& entry) {
  if (is_of_experiments(entry)) {
    if (entry.parent.empty()) return "an experiment (YAML)";
    if (entry.parent == "experiment") return fmt::format("{}: of an experiment (YAML)", entry.name);
    return fmt::format("{}: in {} of an experiment (YAML)", entry.name, entry.parent);
  }
  const std::string parent =
      is_extension(entry.parent) ? fmt::format("cohort:{}", entry.parent) : std::string(entry.parent);
  return fmt::format("<cohort:{}{}> in <{}>", entry.name, entry.has_name ? " name=\"…\"" : "", parent);
}

std::string manual_of_entry(const Extension& entry) {
  std::string text = title_of(entry) + "\n  " + plain(entry.doc) + "\n";
  std::size_t name_width = 0;
  std::size_t unit_width = 0;
  std::size_t fallback_width = std::string_view("required").size();
  for (const ExtensionKey& key : entry.keys) {
    name_width = std::max(name_width, key.name.size());
    unit_width = std::max(unit_width, key.unit.size());
    fallback_width = std::max(fallback_width, key.fallback.size());
  }
  for (const ExtensionKey& key : entry.keys)
    text += fmt::format("    {:<{}}  {:<{}}  {:<{}}  {}\n", key.name, name_width, key.unit, unit_width,
                        key.required() ? "required" : key.fallback, fallback_width, plain(key.doc));
  return text;
}

}  // namespace

std::vector<std::string> manual_topics() {
  std::vector<std::string> topics;
  for (const Group& group : groups) topics.emplace_back(group.name);
  for (const Extension* entry : all_entries())
    if (std::find(topics.begin(), topics.end(), entry->name) == topics.end()) topics.emplace_back(entry->name);
  return topics;
}

std::string manual_contents() {
  std::string text = "Topics of 'cohort help':\n";
  for (const Group& group : groups) {
    std::vector<std::string_view> names;  // one may stand in several elements
    for (const Extension* entry : all_entries())
      if (entry->topic == group.name && entry->name != group.name &&
          std::ranges::find(names, entry->name) == names.end())
        names.push_back(entry->name);
    text += fmt::format("  {:<12}{}{}{}\n", group.name, group.text, names.empty() ? "" : ": ", fmt::join(names, ", "));
  }
  return text + "Each of the names is a topic too. docs/worlds.md has all of it, and examples.\n";
}

std::optional<std::string> manual_of(const std::string& topic) {
  std::vector<const Extension*> found;
  const auto take = [&](const auto& fits) {
    if (!found.empty()) return;
    for (const Extension* entry : all_entries())
      if (fits(*entry)) found.push_back(entry);
  };
  take([&](const Extension& entry) { return entry.topic == topic; });
  take([&](const Extension& entry) { return entry.name == topic; });
  take([&](const Extension& entry) { return !topic.empty() && entry.name.find(topic) != std::string_view::npos; });
  if (found.empty()) return std::nullopt;
  std::string text;
  for (const Extension* entry : found) text += (text.empty() ? "" : "\n") + manual_of_entry(*entry);
  return text;
}

}  // namespace cohort::tool
