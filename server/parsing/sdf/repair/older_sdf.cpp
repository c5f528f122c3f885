#include "server/parsing/sdf/repair/older_sdf.hpp"

#include <sdf/sdf_config.h>

#include <algorithm>
#include <map>
#include <optional>
#include <sdf/SDFImpl.hh>
#include <string>
#include <string_view>
#include <vector>

#include "server/core/text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

// Declared in a header that libsdformat does not install: its embedded files by name, such as `1.7/1_6.convert`.
namespace sdf {
inline namespace SDF_VERSION_NAMESPACE {
const std::map<std::string, std::string>& GetEmbeddedSdf();
}
}  // namespace sdf

// Each rule works like the Converter of libsdformat. Names with '::', which it converts to models, are joined before.
namespace cohort::parsing {
namespace {

/// The conversion of one version to a later one.
struct Conversion {
  std::string to;
  XmlNode rules;  ///< <convert>, which holds <rename>, <move>, … and a <convert> for each child that has rules
};

// Returns the conversions by the version from which they convert.
std::map<std::string, Conversion> read_conversions() {
  constexpr std::string_view ending = ".convert";
  std::map<std::string, Conversion> conversions;
  for (const auto& [path, text] : sdf::GetEmbeddedSdf()) {
    const std::size_t slash = path.find('/');
    if (!path.ends_with(ending) || slash == std::string::npos) continue;
    std::string from = path.substr(slash + 1, path.size() - ending.size() - slash - 1);
    std::ranges::replace(from, '_', '.');
    conversions.emplace(std::move(from), Conversion{path.substr(0, slash), outline_xml(text).root});
  }
  return conversions;
}

using Path = std::vector<std::string>;

Path parts_of(const std::string& text, const std::string& between) {
  Path parts;
  std::size_t begin = 0;
  for (std::size_t end = text.find(between); end != std::string::npos; end = text.find(between, begin)) {
    parts.push_back(text.substr(begin, end - begin));
    begin = end + between.size();
  }
  parts.push_back(text.substr(begin));
  return parts;
}

// Returns the element at the path without its last part; nullptr if there is none.
XmlNode* around_last(XmlNode& node, const Path& path) {
  XmlNode* at = &node;
  for (std::size_t i = 0; i + 1 < path.size() && at != nullptr; ++i) at = child_of(*at, path[i]);
  return at;
}

// Returns the same, and adds missing elements. The first `count` parts are elements.
XmlNode& make_path(XmlNode& node, const Path& path, std::size_t count) {
  XmlNode* at = &node;
  for (std::size_t i = 0; i < count; ++i) {
    XmlNode* const next = child_of(*at, path[i]);
    at = next != nullptr ? next : &at->children.emplace_back(element_at(*at, path[i]));
  }
  return *at;
}

std::optional<std::string> text_of(const XmlNode* node) {
  return node != nullptr && !node->text.empty() ? std::optional(node->text) : std::nullopt;
}

std::optional<std::string> attribute_of(const XmlNode* node, const std::string& name) {
  const std::string* const value = node != nullptr ? node->attribute(name) : nullptr;
  return value != nullptr ? std::optional(*value) : std::nullopt;
}

void remove_attribute(XmlNode& node, const std::string& name) {
  std::erase_if(node.attributes, [&](const auto& attribute) { return attribute.first == name; });
}

void remove_child(XmlNode& node, const XmlNode* child) {
  node.children.erase(node.children.begin() + (child - node.children.data()));
}

/// The target of a <from> or a <to> of a rule.
struct End {
  std::string element;
  std::string attribute;

  End(const XmlNode& rule, std::string_view which) {
    const XmlNode* const end = rule.child(which);
    if (end == nullptr) return;
    element = value_of(*end, "element");
    attribute = value_of(*end, "attribute");
  }
};

// Renames a value in place; of an element, only the value is kept.
void rename(XmlNode& node, const XmlNode& rule) {
  const End from(rule, "from");
  const End to(rule, "to");
  XmlNode* const source = from.element.empty() ? nullptr : child_of(node, from.element);
  const auto value = from.element.empty()     ? attribute_of(&node, from.attribute)
                     : from.attribute.empty() ? text_of(source)
                                              : attribute_of(source, from.attribute);
  if (!value) return;
  XmlNode renamed = element_at(source != nullptr ? *source : node, to.element);
  if (to.attribute.empty())
    renamed.text = *value;
  else
    set_attribute(renamed, to.attribute, *value);
  if (source != nullptr) {
    *source = std::move(renamed);
    return;
  }
  remove_attribute(node, from.attribute);
  node.children.push_back(std::move(renamed));
}

// Moves an element with its content. Paths have '::' between their parts.
void move(XmlNode& node, const XmlNode& rule, bool copies) {
  const End from(rule, "from");
  const End to(rule, "to");
  const Path source = parts_of(from.element.empty() ? from.attribute : from.element, "::");
  const Path target = parts_of(to.element.empty() ? to.attribute : to.element, "::");
  if (around_last(node, source) == nullptr) return;
  const bool is_attribute_of_element = !to.element.empty() && !to.attribute.empty();
  XmlNode& target_around = make_path(node, target, target.size() - (is_attribute_of_element ? 0 : 1));
  XmlNode& source_around = *around_last(node, source);
  if (from.element.empty()) {
    const auto value = attribute_of(&source_around, source.back());
    if (!value) return;
    if (!copies) remove_attribute(source_around, source.back());
    if (to.element.empty())
      set_attribute(target_around, target.back(), *value);
    else
      target_around.children.push_back(element_at(target_around, target.back(), *value));
    return;
  }
  const XmlNode* const moved = source_around.child(source.back());
  if (moved == nullptr) return;
  if (!to.element.empty() && to.attribute.empty()) {
    XmlNode copy = *moved;
    copy.name = target.back();
    if (!copies) remove_child(source_around, moved);
    // The removal may have moved the parent of the target in memory.
    make_path(node, target, target.size() - 1).children.push_back(std::move(copy));
    return;
  }
  const auto value = text_of(moved);
  if (!value) return;
  set_attribute(target_around, to.attribute, *value);
  if (!copies) remove_child(source_around, moved);
}

// Maps one of several values to another value at another path. Paths have '/' between their parts.
void map(XmlNode& node, const XmlNode& rule) {
  const XmlNode& from = *rule.child("from");
  const XmlNode& to = *rule.child("to");
  const Path source = parts_of(value_of(from, "name"), "/");
  const Path target = parts_of(value_of(to, "name"), "/");
  XmlNode* const around = around_last(node, source);
  if (around == nullptr) return;
  const auto value = source.back().starts_with('@') ? attribute_of(around, source.back().substr(1))
                                                    : text_of(around->child(source.back()));
  // If there are fewer target values, the last one is used for all remaining ones.
  std::optional<std::string> mapped;
  for (std::size_t i = 0; i < from.children.size() && value; ++i)
    if (from.children[i].text == *value) mapped = to.children[std::min(i, to.children.size() - 1)].text;
  if (!mapped) return;
  if (target.back().starts_with('@'))
    set_attribute(make_path(node, target, target.size() - 1), target.back().substr(1), *mapped);
  else
    make_path(node, target, target.size()).text = *mapped;
}

void add(XmlNode& node, const XmlNode& rule) {
  if (const auto attribute = attribute_of(&rule, "attribute"))
    set_attribute(node, *attribute, value_of(rule, "value"));
  else
    node.children.push_back(element_at(node, value_of(rule, "element"), value_of(rule, "value")));
}

void remove(XmlNode& node, const XmlNode& rule, bool only_if_empty) {
  if (const auto attribute = attribute_of(&rule, "attribute")) {
    if (!only_if_empty || value_of(node, *attribute).empty()) remove_attribute(node, *attribute);
    return;
  }
  const std::string name = value_of(rule, "element");
  std::erase_if(node.children, [&](const XmlNode& child) {
    const bool is_empty = child.attributes.empty() && child.children.empty() && child.text.empty();
    return child.name == name && (!only_if_empty || is_empty);
  });
}

void convert(XmlNode& node, const XmlNode& rules);

void convert_descendants(XmlNode& node, const std::string& name, const XmlNode& rules) {
  if (node.name == "plugin" || node.name.find(':') != std::string::npos) return;
  for (XmlNode& child : node.children) {
    if (child.name == name) convert(child, rules);
    convert_descendants(child, name, rules);
  }
}

void convert(XmlNode& node, const XmlNode& rules) {
  for (const XmlNode& rule : rules.children) {
    if (rule.name != "convert") continue;
    if (const auto name = attribute_of(&rule, "name"))
      for (XmlNode& child : node.children)
        if (child.name == *name) convert(child, rule);
    if (const auto name = attribute_of(&rule, "descendant_name")) convert_descendants(node, *name, rule);
  }
  for (const XmlNode& rule : rules.children) {
    if (rule.name == "rename") rename(node, rule);
    if (rule.name == "copy" || rule.name == "move") move(node, rule, rule.name == "copy");
    if (rule.name == "map") map(node, rule);
    if (rule.name == "add") add(node, rule);
    if (rule.name == "remove" || rule.name == "remove_empty") remove(node, rule, rule.name == "remove_empty");
  }
}

// In an <include>, files of any older version may have the attribute; its name is that up to SDF 1.6.
void rename_frames_of_includes(XmlNode& node) {
  for (XmlNode& child : node.children) {
    if (child.name == "world" || child.name == "model") rename_frames_of_includes(child);
    if (child.name != "include") continue;
    for (XmlNode& part : child.children)
      for (auto& [name, value] : part.attributes)
        if (part.name == "pose" && name == "frame") name = "relative_to";
  }
}

}  // namespace

void convert_older(XmlNode& sdf) {
  static const std::map<std::string, Conversion> conversions = read_conversions();
  rename_frames_of_includes(sdf);
  for (auto next = conversions.find(value_of(sdf, "version"));
       next != conversions.end() && value_of(sdf, "version") != sdf::SDF::Version();
       next = conversions.find(next->second.to)) {
    convert(sdf, next->second.rules);
    set_attribute(sdf, "version", next->second.to);
  }
  set_attribute(sdf, "version", sdf::SDF::Version());
}

}  // namespace cohort::parsing
