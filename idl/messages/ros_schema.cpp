// SPDX-License-Identifier: Apache-2.0
#include "idl/messages/ros_schema.hpp"

#include <map>
#include <set>

namespace cohort::messages {
namespace {

// Adds nested messages depth first, by name, like rosbag2.
void add_parts(std::string& text, const RosDefinition& definition, std::set<std::string>& known) {
  std::map<std::string, const RosDefinition*> parts;
  for (const RosDefinition& part : definition.parts) parts.emplace(part.name, &part);
  for (const auto& [name, part] : parts) {
    if (!known.insert(name).second) continue;
    text += "\n" + std::string(80, '=') + "\nMSG: " + name + "\n" + part->text;
    add_parts(text, *part, known);
  }
}

}  // namespace

std::string schema_text(const RosDefinition& definition) {
  std::string text = definition.text;
  std::set<std::string> known;
  add_parts(text, definition, known);
  return text;
}

std::string short_type(std::string_view type) {
  const std::size_t first = type.find('/');
  const std::size_t last = type.rfind('/');
  return std::string(type.substr(0, first)) + std::string(type.substr(last));
}

}  // namespace cohort::messages
