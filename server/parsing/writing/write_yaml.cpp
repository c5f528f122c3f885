// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <sstream>

#include "server/core/text.hpp"
#include "server/parsing/files/sdf_version.hpp"
#include "server/parsing/sdf/schema/sdf_schema.hpp"
#include "server/parsing/sdf/schema/yaml_sdf.hpp"

namespace cohort::parsing {
namespace {

bool is_alphanumeric(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// Returns whether YAML reads the text unchanged without quotation marks.
bool is_plain(const std::string& text) {
  if (text.empty() || text == "null" || text == "Null" || text == "NULL") return false;
  const bool has_sign = text.size() > 1 && (text[0] == '-' || text[0] == '+');
  const char first = text[has_sign ? 1 : 0];
  const bool starts_well = is_alphanumeric(first) || (!has_sign && (first == '_' || first == '/'));
  if (!starts_well || text.back() == ' ' || text.back() == ':') return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_inner_colon = text[i] == ':' && text[i + 1] != ' ';
    if (!is_alphanumeric(text[i]) && !is_inner_colon && std::string_view("_./+- ").find(text[i]) == std::string::npos)
      return false;
  }
  return true;
}

std::string scalar(const std::string& text) {
  if (is_plain(text)) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    switch (c) {
      case '"': quoted += "\\\""; break;
      case '\\': quoted += "\\\\"; break;
      case '\n': quoted += "\\n"; break;
      case '\r': quoted += "\\r"; break;
      case '\t': quoted += "\\t"; break;
      default: quoted += c;
    }
  }
  return quoted + '"';
}

// Several numbers become a list.
std::string value_text(const std::string& text, const ElementSchema& schema) {
  const std::vector<std::string_view> parts = words(text);
  const bool are_plain = std::all_of(parts.begin(), parts.end(), [](std::string_view part) {
    return std::all_of(part.begin(), part.end(),
                       [](char c) { return is_alphanumeric(c) || c == '.' || c == '-' || c == '+'; });
  });
  if (!schema.is_vector() || parts.size() < 2 || !are_plain) return scalar(text);
  std::string list;
  for (const std::string_view part : parts) list += (list.empty() ? "[" : ", ") + std::string(part);
  return list + "]";
}

std::string lines_of(const XmlNode& node, const ElementSchema& schema);

// Returns the text after the colon of a key: a value on the same line, or lines below it.
std::string after_key(const XmlNode& node, const ElementSchema& schema) {
  if (!node.attributes.empty() || !node.children.empty()) {
    std::istringstream lines(lines_of(node, schema));
    std::string text = "\n";
    for (std::string line; std::getline(lines, line);) text += "  " + line + "\n";
    return text;
  }
  return (node.text.empty() ? "" : " " + value_text(node.text, schema)) + "\n";
}

std::string list_item(const XmlNode& node, const ElementSchema& schema) {
  if (node.attributes.empty() && node.children.empty())
    return "-" + (node.text.empty() ? "" : " " + value_text(node.text, schema)) + "\n";
  std::istringstream lines(lines_of(node, schema));
  std::string text;
  for (std::string line; std::getline(lines, line);) text += (text.empty() ? "- " : "  ") + line + "\n";
  return text;
}

std::string key_of_child(const std::string& name, const ElementSchema& schema) {
  if (schema.is_extension() && has_prefix(name)) return std::string(without_prefix(name));
  const bool would_be_an_attribute = schema.takes_anything() && schema.has_attribute(name);
  return would_be_an_attribute ? "\"=" + name + "\"" : name;
}

// Returns whether all children of the same name are adjacent.
bool are_in_groups(const std::vector<XmlNode>& children) {
  std::set<std::string_view> done;
  for (std::size_t i = 0; i < children.size(); ++i) {
    if (i > 0 && children[i].name == children[i - 1].name) continue;
    if (!done.insert(children[i].name).second) return false;
  }
  return true;
}

// Writes children under one key, which keeps the order of elements of different names.
std::string lines_of_mixed_children(const XmlNode& node, const ElementSchema& schema) {
  std::string text = schema.takes_anything() ? "\"=elements\":\n" : "elements:\n";
  for (const XmlNode& child : node.children) {
    std::istringstream lines(key_of_child(child.name, schema) + ":" + after_key(child, schema.child(child.name)));
    bool is_first = true;
    for (std::string line; std::getline(lines, line); is_first = false)
      text += (is_first ? "  - " : "    ") + line + "\n";
  }
  return text;
}

std::string lines_of_children(const XmlNode& node, const ElementSchema& schema) {
  if (!are_in_groups(node.children)) return lines_of_mixed_children(node, schema);
  std::string text;
  for (std::size_t i = 0; i < node.children.size();) {
    const std::string& name = node.children[i].name;
    const ElementSchema child = schema.child(name);
    std::size_t end = i;
    while (end < node.children.size() && node.children[end].name == name) ++end;
    text += key_of_child(name, schema) + ":";
    if (end - i == 1) {
      text += after_key(node.children[i], child);
    } else {
      text += "\n";
      for (std::size_t each = i; each < end; ++each) {
        std::istringstream lines(list_item(node.children[each], child));
        for (std::string line; std::getline(lines, line);) text += "  " + line + "\n";
      }
    }
    i = end;
  }
  return text;
}

std::string lines_of(const XmlNode& node, const ElementSchema& schema) {
  std::string text;
  for (const auto& [name, value] : node.attributes) {
    const bool is_known = schema.has_attribute(name) || name.starts_with("xmlns:");
    text += (is_known ? name : "\"@" + name + "\"") + ": " + scalar(value) + "\n";
  }
  if (!node.text.empty())
    text += (schema.takes_anything() ? "\"=value\": " : "value: ") + value_text(node.text, schema) + "\n";
  return text + lines_of_children(node, schema);
}

}  // namespace

std::string yaml_of_sdf(const XmlNode& sdf) {
  XmlNode root = sdf;
  std::erase_if(root.attributes, [](const auto& attribute) {
    return (attribute.first == "version" && attribute.second == converted_version) || attribute.first == "xmlns:cohort";
  });
  return root.attributes.empty() ? lines_of(root, ElementSchema::root())
                                 : "sdf:" + after_key(root, ElementSchema::root());
}

}  // namespace cohort::parsing
