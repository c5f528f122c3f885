// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/manual/reference_pages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <span>
#include <string_view>

#include "server/parsing/keys/details.hpp"
#include "server/parsing/keys/extensions.hpp"
#include "tools/cli/commands/manual/element_pages.hpp"
#include "tools/cli/commands/manual/entries.hpp"
#include "tools/cli/commands/manual/page_text.hpp"

namespace cohort::tool {
namespace {

using parsing::Extension;
using parsing::ExtensionKey;
using parsing::ExtensionValue;

struct Page {
  std::string_view file;
  std::string_view title;
  std::initializer_list<std::string_view> topics;
};
const Page pages[] = {
    {"sensors.md", "Sensors", {"sensors", "samples"}},
    {"actuators.md", "Actuators", {"actuators"}},
    {"emitters.md", "Emitters and climate", {"emitters"}},
    {"physics.md", "Physics and materials", {"physics"}},
    {"placement.md", "Populations and placement", {"placement"}},
    {"experiments.md", "Experiments", {"experiment", "selectors", "print", "history", "record"}},
    {"events.md", "Events and stop conditions", {"events", "stop"}},
    {"ros2.md", "ROS 2", {"ros2"}},
};

// As a sentence: with a capital letter, unless it begins with the name of a quantity, and a full stop.
std::string sentence(std::string_view doc) {
  std::string text(doc);
  if (text.size() > 1 && text[1] >= 'a' && text[1] <= 'z' && text[0] >= 'a' && text[0] <= 'z')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  if (!text.empty() && !text.ends_with('.')) text += '.';
  return text;
}

std::string kind_of(ExtensionValue value) {
  switch (value) {
    case ExtensionValue::name: return "name";
    case ExtensionValue::object: return "scoped name";
    case ExtensionValue::uri: return "path";
    case ExtensionValue::choice: return "word";
    case ExtensionValue::flag: return "`true` or `false`";
    case ExtensionValue::real: return "number";
    case ExtensionValue::non_negative: return "number ≥ 0";
    case ExtensionValue::positive: return "number > 0";
    case ExtensionValue::fraction: return "number from 0 to 1";
    case ExtensionValue::count: return "whole number from 1 to 1,000,000";
    case ExtensionValue::whole: return "whole number ≥ 0";
    case ExtensionValue::point: return "2 numbers";
    case ExtensionValue::vector: return "3 numbers";
    case ExtensionValue::place: return "x, y and heading";
    case ExtensionValue::pose: return "pose";
    case ExtensionValue::group: return "";
  }
  return "";
}

// Type, unit, and what holds if the key is absent.
std::string facts_of(const ExtensionKey& key, bool in_yaml) {
  std::string kind = key.value == ExtensionValue::group ? (in_yaml ? "map or list" : "element") : kind_of(key.value);
  const auto is_explained = [&](std::string_view choice) {
    return key.doc.find(fmt::format("`{}`", choice)) != std::string_view::npos;
  };
  if (key.value == ExtensionValue::choice && !std::ranges::all_of(key.choices, is_explained))
    kind = fmt::format("one of `{}`", fmt::join(key.choices, "`, `"));
  if (key.unit == "of the reading")
    kind += " · unit of the reading";
  else if (!key.unit.empty() && key.unit != "1")
    kind += fmt::format(" · {}", key.unit);
  if (key.repeats) kind += in_yaml ? " · or a list" : " · any number of times";
  if (key.required()) return kind + " · **required**";
  if (key.fallback == parsing::no_value) return kind + " · optional";
  const bool is_described = key.fallback.starts_with("the ") || key.fallback.starts_with("its ");
  return kind +
         (is_described ? fmt::format(" · default: {}", key.fallback) : fmt::format(" · default `{}`", key.fallback));
}

std::string keys_text(std::span<const ExtensionKey> keys, bool in_yaml) {
  std::string text;
  for (const ExtensionKey& key : keys) {
    text += wrapped(fmt::format("- **`{}`** · {}", key.name, facts_of(key, in_yaml)), "  ") + "\\\n  ";
    text += wrapped(sentence(key.doc), "  ") + "\n";
  }
  return text;
}

std::string heading_of(const Extension& entry) {
  if (!is_of_experiments(entry))
    return fmt::format("`<cohort:{}{}>` in `<{}>`", entry.name, entry.has_name ? " name=\"…\"" : "", parent_of(entry));
  if (entry.parent.empty()) return "Keys of an experiment";
  if (entry.parent.find(' ') != std::string_view::npos) return fmt::format("`{}` in {}", entry.name, entry.parent);
  return fmt::format("`{}` in `{}`", entry.name, entry.parent);
}

bool has_keys_of_sensors(const Extension& entry) {
  return entry.keys.size() >= parsing::sensor_keys().size() &&
         std::ranges::equal(entry.keys.last(parsing::sensor_keys().size()), parsing::sensor_keys(), {},
                            &ExtensionKey::name, &ExtensionKey::name);
}

constexpr std::string_view keys_of_sensors = "Keys of every sensor";

std::string entry_text(const Extension& entry, const Page& page) {
  std::string text = fmt::format("\n## {}\n\n{}\n", heading_of(entry), wrapped(entry.doc, ""));
  const bool in_yaml = is_of_experiments(entry);
  const bool is_sensor = has_keys_of_sensors(entry);
  const auto own = entry.keys.first(entry.keys.size() - (is_sensor ? parsing::sensor_keys().size() : 0));
  if (entry.value != ExtensionValue::group)
    text += fmt::format("\nIts value: {}.\n", kind_of(entry.value));
  else if (entry.keys.empty())
    text += "\nIt has no keys.\n";
  else if (!own.empty())
    text += "\n" + keys_text(own, in_yaml);
  if (is_sensor)
    text += fmt::format("\n{}he [keys of every sensor]({}#{}){}.\n", own.empty() ? "It has t" : "Also t",
                        page.file == "sensors.md" ? "" : "sensors.md", anchor_of(keys_of_sensors),
                        own.empty() ? "" : " belong to it");
  if (const std::string_view details = parsing::details_of(entry); !details.empty())
    text += fmt::format("\n{}", details);
  return text;
}

std::string page_text(const Page& page) {
  std::string text = fmt::format("{}\n# {}\n", made_from("server/parsing/keys"), page.title);
  for (const std::string_view topic : page.topics) {
    const std::string_view details = parsing::details_of_topic(topic);
    if (topic != *page.topics.begin() && !details.empty()) {
      std::string heading(topic);
      heading[0] = static_cast<char>(heading[0] - 'a' + 'A');
      text += fmt::format("\n## {}\n", heading);
    }
    if (!details.empty()) text += fmt::format("\n{}", details);
    if (topic == "sensors")
      text += fmt::format("\n## {}\n\n{}", keys_of_sensors, keys_text(parsing::sensor_keys(), false));
    for (const Extension* entry : entries_of(topic)) text += entry_text(*entry, page);
  }
  return text;
}

std::string index_text() {
  std::string text = fmt::format(
      "{}\n# Reference\n\nThese pages list every `cohort:` element of a world and every key of an experiment. They are "
      "generated\nfrom the tables against which Cohort checks files. `cohort help TOPIC` prints the same in a "
      "terminal.\n"
      "[Worlds and experiments](../worlds.md) and [devices](../devices.md) are the guides.\n\n"
      "## Values\n\n{}",
      made_from("server/parsing/keys"), parsing::details_of_topic("values"));
  for (const Page& page : pages) {
    text += fmt::format("\n## [{}]({})\n\n", page.title, page.file);
    for (const std::string_view topic : page.topics)
      for (const Extension* entry : entries_of(topic)) {
        const std::string title = heading_of(*entry);
        text += wrapped(fmt::format("- [{}]({}#{}): {}", title, page.file, anchor_of(title), entry->doc), "  ") + "\n";
      }
  }
  return text +
         "\n## Elements of other formats\n\n- [Every element of SDFormat](sdf-elements.md), with its effect in Cohort\n"
         "- [Every element of URDF](urdf-elements.md), with its effect in Cohort\n";
}

}  // namespace

std::vector<ReferencePage> reference_pages() {
  std::vector<ReferencePage> all = {{"README.md", index_text()}};
  for (const Page& page : pages) all.push_back({std::string(page.file), page_text(page)});
  all.push_back({"sdf-elements.md", sdf_elements()});
  all.push_back({"urdf-elements.md", urdf_elements()});
  return all;
}

}  // namespace cohort::tool
