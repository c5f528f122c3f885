#include "server/parsing/sdf/urdf/urdf_gazebo.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <iterator>

#include "server/core/text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

enum class Kind { number, flag, inverted_flag, text };

/// An element of <gazebo>, and the path of the element of SDF that it sets. Without a path it sets nothing.
struct Property {
  std::string_view name;
  GazeboTarget target;
  Kind kind;
  std::string_view path;
};

using enum GazeboTarget;

constexpr Property properties[] = {
    {"mu1", collision, Kind::number, "surface/friction/ode/mu"},
    {"mu2", collision, Kind::number, "surface/friction/ode/mu2"},
    {"fdir1", collision, Kind::text, "surface/friction/ode/fdir1"},
    {"kp", collision, Kind::number, "surface/contact/ode/kp"},
    {"kd", collision, Kind::number, "surface/contact/ode/kd"},
    {"maxVel", collision, Kind::number, "surface/contact/ode/max_vel"},
    {"minDepth", collision, Kind::number, "surface/contact/ode/min_depth"},
    {"laserRetro", collision, Kind::number, "laser_retro"},
    {"maxContacts", collision, Kind::number, "max_contacts"},
    {"material", visual, Kind::text, "material/script/name"},
    {"turnGravityOff", link, Kind::inverted_flag, "gravity"},
    {"dampingFactor", link, Kind::number, "velocity_decay/linear"},
    {"dampingFactor", link, Kind::number, "velocity_decay/angular"},
    {"selfCollide", link, Kind::flag, "self_collide"},
    {"stopCfm", joint, Kind::number, "physics/ode/limit/cfm"},
    {"stopErp", joint, Kind::number, "physics/ode/limit/erp"},
    {"springReference", joint, Kind::number, "axis/dynamics/spring_reference"},
    {"springStiffness", joint, Kind::number, "axis/dynamics/spring_stiffness"},
    {"provideFeedback", joint, Kind::flag, "physics/provide_feedback"},
    {"provideFeedback", joint, Kind::flag, "physics/ode/provide_feedback"},
    {"implicitSpringDamper", joint, Kind::flag, "physics/ode/implicit_spring_damper"},
    {"implicitSpringDamper", joint, Kind::flag, "physics/ode/cfm_damping"},
    {"cfmDamping", joint, Kind::flag, "physics/ode/implicit_spring_damper"},
    {"cfmDamping", joint, Kind::flag, "physics/ode/cfm_damping"},
    {"fudgeFactor", joint, Kind::number, "physics/ode/fudge_factor"},
    {"static", robot, Kind::flag, "static"},
    {"stopKp", joint, Kind::number, ""},
    {"stopKd", joint, Kind::number, ""},
    {"initialJointPosition", joint, Kind::number, ""},
    {"preserveFixedJoint", joint, Kind::flag, ""},
    {"disableFixedJointLumping", joint, Kind::flag, ""},
    {"canonicalBody", robot, Kind::text, ""},
    {"collision", link, Kind::text, ""},
    {"visual", link, Kind::text, ""},
};

bool is_one_of(const XmlNode& element, std::initializer_list<std::string_view> values) {
  std::string value = gazebo_value(element);
  std::ranges::transform(value, value.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(values, value) != values.end();
}

std::string sdf_value(const XmlNode& element, Kind kind) {
  if (kind == Kind::flag) return is_true(element) ? "true" : "false";
  if (kind == Kind::inverted_flag) return is_one_of(element, {"false", "no", "0"}) ? "true" : "false";
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

std::string gazebo_value(const XmlNode& element) {
  const std::string* const value = element.attribute("value");
  return std::string(trimmed(value != nullptr ? *value : element.text));
}

bool is_true(const XmlNode& element) { return is_one_of(element, {"true", "yes", "1"}); }

bool is_gazebo_number(std::string_view name) {
  const auto found = std::ranges::find(properties, name, &Property::name);
  return found != std::end(properties) && found->kind == Kind::number;
}

bool is_gazebo_property(std::string_view name) {
  return std::ranges::find(properties, name, &Property::name) != std::end(properties);
}

void set_gazebo_properties(const XmlNode& block, GazeboTarget target, XmlNode& element) {
  if (target == collision || target == visual) add_content_for(block, element);
  for (const XmlNode& child : block.children)
    for (const Property& property : properties) {
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
