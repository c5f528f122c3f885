// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/manual/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <regex>

#include "server/core/text.hpp"
#include "server/parsing/keys/details.hpp"
#include "tools/cli/commands/manual/entries.hpp"

namespace cohort::tool {
namespace {

using parsing::Extension;
using parsing::ExtensionKey;

// Without what only a browser needs.
std::string plain(std::string_view doc) {
  static const std::regex link(R"(\[([^\]]*)\]\([^)]*\))");
  static const std::regex marks(R"(```\w*\n|\*\*|##+ )");
  std::string text = std::regex_replace(std::regex_replace(std::string(doc), marks, ""), link, "$1");
  std::erase(text, '`');
  return text;
}

// Returns a default as people read it: a number has at most six significant digits.
std::string shown(std::string_view fallback) {
  const std::optional<double> number = parse_real(fallback);
  const bool is_long = fallback.size() > std::string_view("-1.23456e-10").size();
  return number && is_long ? fmt::format("{:.6g}", *number) : std::string(fallback);
}

std::string title_of(const Extension& entry) {
  if (is_of_experiments(entry)) {
    if (entry.parent.empty()) return "an experiment (YAML)";
    if (entry.parent == "experiment") return fmt::format("{}: part of an experiment (YAML)", entry.name);
    return fmt::format("{}: part of {} in an experiment (YAML)", entry.name, entry.parent);
  }
  return fmt::format("<cohort:{}{}> in <{}>", entry.name, entry.has_name ? " name=\"…\"" : "", parent_of(entry));
}

// Lines of an explanation, with `indent` before each.
std::string indented(std::string_view details, std::string_view indent) {
  const std::string lines = plain(details);
  std::string text;
  for (std::size_t begin = 0, end = 0; begin < lines.size(); begin = end + 1) {
    end = std::min(lines.find('\n', begin), lines.size());
    if (end > begin) text += fmt::format("{}{}", indent, std::string_view(lines).substr(begin, end - begin));
    text += '\n';
  }
  return text;
}

std::string manual_of_entry(const Extension& entry) {
  std::string text = title_of(entry) + "\n  " + plain(entry.doc) + "\n";
  std::size_t name_width = 0;
  std::size_t unit_width = 0;
  std::size_t fallback_width = std::string_view("required").size();
  for (const ExtensionKey& key : entry.keys) {
    name_width = std::max(name_width, key.name.size());
    unit_width = std::max(unit_width, key.unit.size());
    fallback_width = std::max(fallback_width, shown(key.fallback).size());
  }
  for (const ExtensionKey& key : entry.keys)
    text += fmt::format("    {:<{}}  {:<{}}  {:<{}}  {}\n", key.name, name_width, key.unit, unit_width,
                        key.required() ? "required" : shown(key.fallback), fallback_width, plain(key.doc));
  const std::string details = indented(parsing::details_of(entry), "  ");
  return text + (details.empty() ? "" : "\n") + details;
}

}  // namespace

std::vector<std::string> manual_topics() {
  std::vector<std::string> all;
  for (const Topic& topic : topics()) all.emplace_back(topic.name);
  for (const Extension* entry : manual_entries())
    if (std::ranges::find(all, entry->name) == all.end()) all.emplace_back(entry->name);
  return all;
}

std::string manual_contents() {
  std::string text = "Topics of 'cohort help':\n";
  for (const Topic& topic : topics()) {
    std::vector<std::string_view> names;  // one may stand in several elements
    for (const Extension* entry : entries_of(topic.name))
      if (entry->name != topic.name && std::ranges::find(names, entry->name) == names.end())
        names.push_back(entry->name);
    text += fmt::format("  {:<12}{}{}{}\n", topic.name, topic.text, names.empty() ? "" : ": ", fmt::join(names, ", "));
  }
  return text +
         "Each name is also a topic. docs/worlds.md and docs/devices.md are guides with examples.\n"
         "'cohort help robot NAME' describes a robot: its size, its mass, and its channels with units and ranges.\n";
}

std::optional<std::string> nearest_topic(const std::string& unknown) {
  std::vector<std::string> texts = manual_topics();
  texts.emplace_back("robot");
  if (auto topic = nearest(unknown, texts)) return topic;
  const std::vector<std::string> topics = texts;
  for (std::string& text : texts) text.resize(std::min(text.find('_'), text.size()));
  const auto first_word = nearest(unknown, texts);
  if (!first_word) return std::nullopt;
  return topics[static_cast<std::size_t>(std::ranges::find(texts, *first_word) - texts.begin())];
}

std::optional<std::string> manual_of(const std::string& topic) {
  std::vector<const Extension*> found;
  const auto take = [&](const auto& fits) {
    if (!found.empty()) return;
    for (const Extension* entry : manual_entries())
      if (fits(*entry)) found.push_back(entry);
  };
  take([&](const Extension& entry) { return entry.topic == topic; });
  take([&](const Extension& entry) { return entry.name == topic; });
  if (!topic.empty() && parsing::details_of_topic(topic).empty())
    take([&](const Extension& entry) { return entry.name.find(topic) != std::string_view::npos; });
  std::string text = indented(parsing::details_of_topic(topic), "");
  if (found.empty() && text.empty()) return std::nullopt;
  for (const Extension* entry : found) text += (text.empty() ? "" : "\n") + manual_of_entry(*entry);
  return text;
}

}  // namespace cohort::tool
