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

/// What writing a world as XML is made of.
namespace cohort::parsing {

/// As few digits as give the same number again.
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

/// SDF keeps "::" for itself: it stands in the names of what was in a model inside of the model.
std::string without_scope_marks(std::string name);

/// How to get to a file from a folder.
std::string relative_to(const std::filesystem::path& folder, const std::filesystem::path& file);

/// In the element of its model, which has those of its links and joints. `folder`: where the world will stand.
void write_device(XmlNode& model_element, const Model& model, const Device& device,
                  const std::filesystem::path& folder);
/// In its link.
/// A GripRing, a Fin or a Drag of a link.
template <class Part>
void write_link_part(XmlNode& link_element, const Part& part);
void write_emitter(XmlNode& link_element, const Emitter& emitter);

}  // namespace cohort::parsing
