// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/urdf/urdf_gazebo.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>

#include "server/core/text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

bool is_one_of(const XmlNode& element, std::initializer_list<std::string_view> values) {
  std::string value = gazebo_value(element);
  std::ranges::transform(value, value.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(values, value) != values.end();
}

std::string sdf_value(const XmlNode& element, GazeboKind kind) {
  if (kind == GazeboKind::flag) return is_true(element) ? "true" : "false";
  if (kind == GazeboKind::inverted_flag) return is_one_of(element, {"false", "no", "0"}) ? "true" : "false";
  return gazebo_value(element);
}

// Adds the elements that a block has for all collisions or visuals. A <surface> or <material> replaces the whole one.
void add_content_for(const XmlNode& block, XmlNode& part) {
  for (const XmlNode& child : block.children) {
    if (child.name != part.name) continue;
    for (const XmlNode& added : child.children) {
      if (added.name == "surface" || added.name == "material")
        std::erase_if(part.children, [&](const XmlNode& old) { return old.name == added.name; });
      part.children.push_back(added);
    }
  }
}

}  // namespace

std::span<const GazeboProperty> gazebo_properties() {
  using enum GazeboTarget;
  using enum GazeboKind;
  static constexpr GazeboProperty all[] = {
      {"mu1", collision, number, "surface/friction/ode/mu"},
      {"mu2", collision, number, "surface/friction/ode/mu2"},
      {"fdir1", collision, text, "surface/friction/ode/fdir1"},
      {"kp", collision, number, "surface/contact/ode/kp"},
      {"kd", collision, number, "surface/contact/ode/kd"},
      {"maxVel", collision, number, "surface/contact/ode/max_vel"},
      {"minDepth", collision, number, "surface/contact/ode/min_depth"},
      {"laserRetro", collision, number, "laser_retro"},
      {"maxContacts", collision, number, "max_contacts"},
      {"material", visual, text, "material/script/name"},
      {"turnGravityOff", link, inverted_flag, "gravity"},
      {"dampingFactor", link, number, "velocity_decay/linear"},
      {"dampingFactor", link, number, "velocity_decay/angular"},
      {"selfCollide", link, flag, "self_collide"},
      {"stopCfm", joint, number, "physics/ode/limit/cfm"},
      {"stopErp", joint, number, "physics/ode/limit/erp"},
      {"springReference", joint, number, "axis/dynamics/spring_reference"},
      {"springStiffness", joint, number, "axis/dynamics/spring_stiffness"},
      {"provideFeedback", joint, flag, "physics/provide_feedback"},
      {"provideFeedback", joint, flag, "physics/ode/provide_feedback"},
      {"implicitSpringDamper", joint, flag, "physics/ode/implicit_spring_damper"},
      {"implicitSpringDamper", joint, flag, "physics/ode/cfm_damping"},
      {"cfmDamping", joint, flag, "physics/ode/implicit_spring_damper"},
      {"cfmDamping", joint, flag, "physics/ode/cfm_damping"},
      {"fudgeFactor", joint, number, "physics/ode/fudge_factor"},
      {"static", robot, flag, "static"},
      {"stopKp", joint, number, ""},
      {"stopKd", joint, number, ""},
      {"initialJointPosition", joint, number, ""},
      {"preserveFixedJoint", joint, flag, ""},
      {"disableFixedJointLumping", joint, flag, ""},
      {"canonicalBody", robot, text, ""},
      {"collision", link, text, ""},
      {"visual", link, text, ""},
  };
  return all;
}

std::string gazebo_value(const XmlNode& element) {
  const std::string* const value = element.attribute("value");
  return std::string(trimmed(value != nullptr ? *value : element.text));
}

bool is_true(const XmlNode& element) { return is_one_of(element, {"true", "yes", "1"}); }

bool is_gazebo_number(std::string_view name) {
  return std::ranges::any_of(gazebo_properties(), [&](const GazeboProperty& property) {
    return property.name == name && property.kind == GazeboKind::number;
  });
}

bool is_gazebo_property(std::string_view name) {
  return std::ranges::find(gazebo_properties(), name, &GazeboProperty::name) != gazebo_properties().end();
}

void set_gazebo_properties(const XmlNode& block, GazeboTarget target, XmlNode& element) {
  if (target == GazeboTarget::collision || target == GazeboTarget::visual) add_content_for(block, element);
  for (const XmlNode& child : block.children)
    for (const GazeboProperty& property : gazebo_properties()) {
      const std::string value = sdf_value(child, property.kind);
      if (property.name != child.name || property.target != target || property.path.empty() || value.empty()) continue;
      set_at(element, property.path, value, child);
      if (child.name == "material")
        set_at(element, "material/script/uri", "file://media/materials/scripts/gazebo.material", child);
    }
}

void set_at(XmlNode& node, std::string_view path, const std::string& text, const XmlNode& where) {
  const std::string name(path.substr(0, path.find('/')));
  XmlNode* child = child_of(node, name);
  if (child == nullptr) child = &node.children.emplace_back(element_at(where, name));
  if (name.size() < path.size()) return set_at(*child, path.substr(name.size() + 1), text, where);
  child->text = text;
  child->line = where.line;
}

}  // namespace cohort::parsing
