// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/repair/older_sdf.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/parsing/files/sdf_version.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

XmlNode& child_or_new(XmlNode& node, const std::string& name) {
  XmlNode* const child = child_of(node, name);
  return child != nullptr ? *child : node.children.emplace_back(element_at(node, name));
}

void remove_attribute(XmlNode& node, std::string_view name) {
  std::erase_if(node.attributes, [&](const auto& attribute) { return attribute.first == name; });
}

void remove_children(XmlNode& node, std::string_view name) {
  std::erase_if(node.children, [&](const XmlNode& child) { return child.name == name; });
}

// Moves the element at the path below `node`, if there is one, to the end of `node`.
void move_up(XmlNode& node, std::string_view path, const std::string& new_name) {
  XmlNode* around = &node;
  for (std::size_t slash = path.find('/'); slash != std::string_view::npos; slash = path.find('/')) {
    around = child_of(*around, path.substr(0, slash));
    if (around == nullptr) return;
    path.remove_prefix(slash + 1);
  }
  XmlNode* const found = child_of(*around, path);
  if (found == nullptr) return;
  XmlNode moved = std::move(*found);
  moved.name = new_name;
  around->children.erase(around->children.begin() + (found - around->children.data()));
  node.children.push_back(std::move(moved));
}

void rename_step_sizes(XmlNode& physics) {
  move_up(physics, "update_rate", "real_time_update_rate");
  move_up(physics, "ode/solver/dt", "max_step_size");
  move_up(physics, "bullet/dt", "max_step_size");
}

// Up to SDF 1.4, axes are expressed in the frame of the model.
void use_model_frame(XmlNode& joint) {
  for (XmlNode& axis : joint.children)
    if (axis.name == "axis" || axis.name == "axis2")
      axis.children.push_back(element_at(axis, "use_parent_model_frame", "true"));
}

void make_static_an_element(XmlNode& actor) {
  const std::string* const value = actor.attribute("static");
  if (value == nullptr) return;
  actor.children.push_back(element_at(actor, "static", *value));
  remove_attribute(actor, "static");
}

void move_fields_to_world(XmlNode& world) {
  move_up(world, "physics/gravity", "gravity");
  move_up(world, "physics/magnetic_field", "magnetic_field");
}

// Up to SDF 1.5, an IMU has one noise for all axes: <noise> with a <type>, and the values in <rate> and <accel>.
void give_noise_to_axes(XmlNode& imu) {
  constexpr std::array<std::pair<const char*, const char*>, 2> quantities{
      {{"angular_velocity", "rate"}, {"linear_acceleration", "accel"}}};
  for (const auto& [quantity, older] : quantities) imu.children.push_back(element_at(imu, quantity));
  const XmlNode* const noise = imu.child("noise");
  if (noise == nullptr) return;
  const XmlNode* const type = noise->child("type");
  for (const auto& [quantity, older] : quantities) {
    const XmlNode* const values = noise->child(older);
    for (const char* const axis : {"x", "y", "z"}) {
      XmlNode& of_axis = child_or_new(child_or_new(*child_of(imu, quantity), axis), "noise");
      if (type != nullptr && !type->text.empty()) set_attribute(of_axis, "type", type->text);
      for (const char* const key : {"mean", "stddev", "bias_mean", "bias_stddev"})
        if (const XmlNode* const value = values != nullptr ? values->child(key) : nullptr)
          of_axis.children.push_back(*value);
    }
  }
  remove_children(imu, "noise");
}

void rename_frame(XmlNode& pose) {
  if (pose.attribute("frame") == nullptr) return;
  const std::string frame = value_of(pose, "frame");
  remove_attribute(pose, "frame");
  set_attribute(pose, "relative_to", frame);
}

void name_frame_of_axes(XmlNode& joint) {
  constexpr std::array<std::string_view, 4> yes{"true", "True", "TRUE", "1"};
  for (XmlNode& axis : joint.children) {
    if (axis.name != "axis" && axis.name != "axis2") continue;
    const XmlNode* const flag = axis.child("use_parent_model_frame");
    if (flag == nullptr) continue;
    if (std::ranges::find(yes, flag->text) != yes.end())
      set_attribute(child_or_new(axis, "xyz"), "expressed_in", "__model__");
    remove_children(axis, "use_parent_model_frame");
  }
}

// From SDF 1.8 on, the pose of an <inertial> has no such attribute.
void remove_empty_frame(XmlNode& inertial) {
  for (XmlNode& pose : inertial.children)
    if (pose.name == "pose" && value_of(pose, "relative_to").empty()) remove_attribute(pose, "relative_to");
}

/// A change of the elements at a path in files before a version.
struct Rule {
  std::pair<int, int> before;
  std::string_view path;  ///< below <sdf>; with "**" in front, elements of the name anywhere
  void (*change)(XmlNode&);
};

// In the order in which they apply. SDF 1.3 and 1.9 only add to the versions before them.
constexpr Rule rules[] = {
    {{1, 4}, "world/physics", rename_step_sizes},
    {{1, 5}, "world/model/joint", use_model_frame},
    {{1, 5}, "model/joint", use_model_frame},
    {{1, 5}, "world/actor", make_static_an_element},
    {{1, 5}, "model/actor", make_static_an_element},
    {{1, 6}, "world", move_fields_to_world},
    {{1, 6}, "world/model/link/sensor/imu", give_noise_to_axes},
    {{1, 6}, "model/link/sensor/imu", give_noise_to_axes},
    {{1, 7}, "**/pose", rename_frame},
    {{1, 7}, "**/joint", name_frame_of_axes},
    {{1, 8}, "**/inertial", remove_empty_frame},
};

void apply(const Rule& rule, XmlNode& node, std::string_view path) {
  const std::size_t slash = path.find('/');
  const bool is_last = slash == std::string_view::npos;
  for (XmlNode& child : node.children) {
    if (child.name != path.substr(0, slash)) continue;
    if (is_last)
      rule.change(child);
    else
      apply(rule, child, path.substr(slash + 1));
  }
}

void apply_anywhere(const Rule& rule, XmlNode& node, std::string_view name) {
  if (node.name == "plugin" || node.name.find(':') != std::string::npos) return;
  for (XmlNode& child : node.children) {
    if (child.name == name) rule.change(child);
    apply_anywhere(rule, child, name);
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
  rename_frames_of_includes(sdf);
  const std::pair<int, int> version = version_of(value_of(sdf, "version"));
  constexpr std::pair<int, int> oldest{1, 2};
  for (const Rule& rule : rules) {
    if (version < oldest || version >= rule.before) continue;
    constexpr std::string_view anywhere = "**/";
    if (rule.path.starts_with(anywhere))
      apply_anywhere(rule, sdf, rule.path.substr(anywhere.size()));
    else
      apply(rule, sdf, rule.path);
  }
  set_attribute(sdf, "version", std::string(converted_version));
}

}  // namespace cohort::parsing
