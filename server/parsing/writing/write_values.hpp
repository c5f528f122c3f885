// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "server/core/pose.hpp"
#include "server/description/model.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/keys/extensions.hpp"

/// Helpers for writing a world as XML.
namespace cohort::parsing {

/// Returns the shortest text that gives the same number when it is read.
std::string text_of(double number);
inline std::string text_of(const std::string& text) { return text; }
inline std::string text_of(bool flag) { return flag ? "true" : "false"; }
inline std::string text_of(std::uint64_t number) { return std::to_string(number); }
std::string text_of(const Eigen::Vector2d& v);
std::string text_of(const Eigen::Vector3d& v);
std::string text_of(const Pose& X);

inline XmlNode& add(XmlNode& parent, std::string name) {
  XmlNode& child = parent.children.emplace_back();
  child.name = std::move(name);
  return child;
}
inline XmlNode& add_named(XmlNode& parent, std::string element, const std::string& name) {
  XmlNode& child = add(parent, std::move(element));
  child.attributes.emplace_back("name", name);
  return child;
}
template <class Value>
XmlNode& add_value(XmlNode& parent, std::string name, const Value& value) {
  XmlNode& child = add(parent, std::move(name));
  child.text = text_of(value);
  return child;
}
template <class Value>
void add_key(XmlNode& extension, std::string_view key, const Value& value) {
  add_value(extension, prefixed(key), value);
}
inline void add_pose(XmlNode& parent, const Pose& X) {
  add_value(parent, "pose", X).attributes.emplace_back("rotation_format", "quat_xyzw");
}

/// Replaces "::", which SDF reserves, by "." in a name of a nested model.
std::string without_scope_marks(std::string name);

/// Returns the path to a file from a folder.
std::string relative_to(const std::filesystem::path& folder, const std::filesystem::path& file);

/// Writes a device into the element of its model, which has the elements of its links and joints. `folder`: folder of
/// the world file.
void write_device(XmlNode& model_element, const Model& model, const Device& device,
                  const std::filesystem::path& folder);
/// Writes a GripRing, a Fin or a Drag into its link.
template <class Part>
void write_link_part(XmlNode& link_element, const Part& part);
void write_emitter(XmlNode& link_element, const Emitter& emitter);

}  // namespace cohort::parsing
