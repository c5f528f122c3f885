// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "server/parsing/files/xml_outline.hpp"

/// Functions that change a tree of XML.
namespace cohort::parsing {

/// Returns the child of this name; nullptr if there is none.
inline XmlNode* child_of(XmlNode& parent, std::string_view name) { return const_cast<XmlNode*>(parent.child(name)); }

/// Returns whether the name of an element or an attribute has the prefix of a namespace.
inline bool has_any_prefix(std::string_view name) { return name.find(':') != std::string_view::npos; }

/// Returns the value of the attribute; empty if there is none.
inline std::string value_of(const XmlNode& node, std::string_view attribute) {
  const std::string* const value = node.attribute(attribute);
  return value != nullptr ? *value : "";
}

inline void set_attribute(XmlNode& node, std::string_view name, const std::string& value) {
  for (auto& attribute : node.attributes)
    if (attribute.first == name) {
      attribute.second = value;
      return;
    }
  node.attributes.emplace_back(name, value);
}

/// Returns whether a name has the prefix of a program.
inline bool has_any_prefix(const std::string& name) { return name.find(':') != std::string::npos; }

/// Returns the name of the element, or the one that an <include> gives; empty if there is none.
inline std::string name_of(const XmlNode& node) {
  if (const std::string* const name = node.attribute("name")) return *name;
  const XmlNode* const name = node.name == "include" ? node.child("name") : nullptr;
  return name != nullptr ? name->text : "";
}

/// Returns an element as a step of a path, such as `model[NAME]`. There is one world, whose name is omitted.
inline std::string path_step(const std::string& element, const std::string& name) {
  return name.empty() || element == "world" ? element : element + "[" + name + "]";
}

inline std::string step_of(const XmlNode& node) { return path_step(node.name, name_of(node)); }

/// Returns the path of a child of the element at `path`, for messages. Parts of a URDF have the link and the name that
/// the URDF gives them.
inline std::string path_below(const std::string& path, const XmlNode& child) {
  if (child.written.empty()) return (path.empty() ? "" : path + "/") + step_of(child);
  const std::size_t link = path.rfind("link[");
  return (link == std::string::npos ? "" : path.substr(0, link)) + child.written;
}

/// Appends the content of a model to `content` as text, without its name and the numbers of its pose.
inline void add_content(const XmlNode& node, std::string& content, bool is_top = true) {
  content += '<' + node.name;
  for (const auto& [name, value] : node.attributes)
    if (!is_top || name != "name") content += ' ' + name + "=\"" + value + '"';
  content += '>' + node.text;
  for (const XmlNode& child : node.children) {
    if (!is_top || child.name != "pose") {
      add_content(child, content, false);
      continue;
    }
    content += "<pose";
    for (const auto& [name, value] : child.attributes) content += ' ' + name + "=\"" + value + '"';
  }
  content += "</>";
}

/// Returns an element with the position of another one.
inline XmlNode element_at(const XmlNode& where, std::string name, std::string text = "") {
  return {std::move(name), where.line, where.file, {}, std::move(text), {}};
}

}  // namespace cohort::parsing
