#include "server/description/sdf_errors.hpp"

#include <algorithm>
#include <optional>
#include <sdf/Error.hh>
#include <string>
#include <string_view>

namespace cohort::description {
namespace {

// `/sdf/world[@name="w"]/model[@name="m"]/link` as `world/model[m]/link`.
std::string readable_path(std::string_view xpath) {
  std::string path;
  if (xpath.starts_with("/sdf/")) xpath.remove_prefix(5);
  while (!xpath.empty()) {
    const std::size_t open = std::min(xpath.find("[@"), xpath.size());
    path += xpath.substr(0, open);
    xpath.remove_prefix(open);
    const std::size_t equals = xpath.find("=\"");
    const std::size_t close = xpath.find("\"]");
    if (xpath.empty() || equals == std::string_view::npos || close == std::string_view::npos) break;
    const std::string_view attribute = xpath.substr(2, equals - 2);
    const std::string_view value = xpath.substr(equals + 2, close - equals - 2);
    if (attribute != "name")
      path += "/@" + std::string(attribute);
    else if (path != "world")
      path += "[" + std::string(value) + "]";
    xpath.remove_prefix(close + 2);
  }
  return path;
}

std::string readable_message(const sdf::Error& error) {
  std::string message = error.Message();
  if (const std::size_t rest = message.find(" Copying["); rest != std::string::npos) message.resize(rest);
  while (!message.empty() && message.back() == '\n') message.pop_back();
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message;
}

bool is_cannot_read_element(const sdf::Error& error) {
  return error.Code() == sdf::ErrorCode::ELEMENT_INVALID && error.Message().starts_with("Error reading element");
}

// Our own checks or the search for models say it with a place.
bool is_said_by_us(const sdf::Error& error) {
  switch (error.Code()) {
    case sdf::ErrorCode::LINK_INERTIA_INVALID:
    case sdf::ErrorCode::URI_LOOKUP:
      return true;
    case sdf::ErrorCode::ELEMENT_INVALID:
      return error.Message() == "Failed to load a world.";
    default:
      return false;
  }
}

struct Place {
  const XmlNode* node;
  std::string path;
};

// The last element of this kind and name under `from`: of two of the same name, the second is the one too many.
std::optional<Place> find_named(const XmlNode& from, const std::string& path, std::string_view kind,
                                std::string_view name) {
  std::optional<Place> found;
  for (const XmlNode& child : from.children) {
    const std::string* const child_name = child.attribute("name");
    std::string child_path = path + (path.empty() ? "" : "/") + child.name;
    if (child_name != nullptr && child.name != "world") child_path += "[" + *child_name + "]";
    if (child.name == kind && child_name != nullptr && *child_name == name) found = Place{&child, child_path};
    if (auto deeper = find_named(child, child_path, kind, name)) found = std::move(deeper);
  }
  return found;
}

// The name in the first `KIND with name[NAME]` of a message, for a kind after `start`.
std::optional<std::string> name_in(std::string_view message, std::string_view kind, std::size_t start = 0) {
  const std::string before = std::string(kind) + " with name[";
  const std::size_t found = message.find(before, start);
  if (found == std::string_view::npos) return std::nullopt;
  const std::size_t begin = found + before.size();
  return std::string(message.substr(begin, message.find(']', begin) - begin));
}

// Errors of libsdformat's second stage carry no place, but names of what they are about: "... specified by joint with
// name[j] ... in model with name[m]".
std::optional<Place> place_named_in(std::string message, const XmlNode& xml) {
  for (const char* const kind : {"Model", "Link", "Joint", "Frame", "Collision"})
    for (std::size_t at = message.find(kind); at != std::string::npos; at = message.find(kind, at))
      message[at] = static_cast<char>(message[at] - 'A' + 'a');

  std::optional<Place> scope;
  if (const auto model = name_in(message, "model")) scope = find_named(xml, "", "model", *model);
  const std::size_t subject = message.find("specified by ");
  const std::size_t start = subject == std::string::npos ? 0 : subject;
  for (const char* const kind : {"joint", "link", "frame", "collision"})
    if (const auto name = name_in(message, kind, start)) {
      const auto place = scope ? find_named(*scope->node, scope->path, kind, *name) : find_named(xml, "", kind, *name);
      if (place) return place;
    }
  return scope;
}

const XmlNode* find_on_line(const XmlNode& node, int line) {
  const XmlNode* found = node.line == line ? &node : nullptr;
  for (const XmlNode& child : node.children)
    if (const XmlNode* const deeper = find_on_line(child, line)) found = deeper;
  return found;
}

}  // namespace

std::vector<Problem> problems_of(const sdf::Errors& errors, const SdfFile& file) {
  std::vector<Problem> problems;
  std::string last_path;
  for (const sdf::Error& error : errors) {
    if (is_said_by_us(error)) continue;
    // An element that cannot be read makes every element around it one that cannot be read.
    const std::string path = error.XmlPath().value_or("");
    const bool is_consequence = is_cannot_read_element(error) && !problems.empty() && last_path.starts_with(path);
    last_path = path;
    if (is_consequence) continue;

    Problem problem{file.shown, error.LineNumber().value_or(0), readable_path(path), readable_message(error)};
    if (problem.line == 0 && path.empty()) {
      if (const auto place = place_named_in(error.Message(), file.xml)) {
        problem.line = place->node->line;
        problem.element = place->path;
      }
    } else if (is_cannot_read_element(error)) {
      const XmlNode* const node = find_on_line(file.xml, problem.line);
      if (node != nullptr && node->children.empty())
        problem.message = "<" + node->name + "> cannot have the value '" + node->text + "'";
    }
    problems.push_back(std::move(problem));
  }
  return problems;
}

}  // namespace cohort::description
