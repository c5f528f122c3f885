// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/urdf/urdf_parts.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/core/text.hpp"
#include "server/geometry/shapes/mass_properties.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"
#include "server/parsing/sdf/urdf/urdf_pose.hpp"

namespace cohort::parsing {
namespace {

using geometry::MassProperties;
using geometry::moved;
using geometry::together;

constexpr std::string_view lump_mark = "_fixed_joint_lump__";
constexpr const char* inertia_names[] = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};

std::string path_in_urdf(const UrdfLink& link, const XmlNode& part) {
  return "link[" + link.name + "]/" + path_step(part.name, value_of(part, "name"));
}

double number_of(const XmlNode& node, std::string_view attribute) {
  return parse_real(value_of(node, attribute)).value_or(0.0);
}

Eigen::Matrix3d inertia_of(const XmlNode& inertial) {
  const XmlNode& node = *inertial.child("inertia");
  const double xy = number_of(node, "ixy"), xz = number_of(node, "ixz"), yz = number_of(node, "iyz");
  Eigen::Matrix3d inertia;
  inertia << number_of(node, "ixx"), xy, xz, xy, number_of(node, "iyy"), yz, xz, yz, number_of(node, "izz");
  return inertia;
}

// Returns whether a body can have this inertia. A sum of such inertias is one that a body can have.
bool is_possible(const XmlNode& inertial) {
  const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia_of(inertial)).eigenvalues();
  return principal[0] > 0.0 && principal[2] <= (principal[0] + principal[1]) * (1.0 + 1e-6);
}

// Returns <inertial> of SDF with the lines of one in URDF. `texts` are those of the moments.
XmlNode inertial_like(const XmlNode& source, const Pose& pose, const std::string& mass,
                      const std::vector<std::string>& texts) {
  const XmlNode& inertia = *source.child("inertia");
  XmlNode made = element_at(source, "inertial");
  made.children = {pose_at(source, pose), element_at(*source.child("mass"), "mass", mass),
                   element_at(inertia, "inertia")};
  for (std::size_t i = 0; i < texts.size(); ++i)
    made.children.back().children.push_back(element_at(inertia, inertia_names[i], texts[i]));
  return made;
}

XmlNode inertial_without_mass(const UrdfLink& link) {
  XmlNode made = element_at(*link.node, "inertial");
  const bool is_fixed_to_world =
      link.parent == nullptr || (value_of(*link.joint, "type") == "fixed" && link.parent->is_world());
  made.children = {element_at(made, "mass", is_fixed_to_world ? "1" : "0")};
  if (!is_fixed_to_world) return made;
  XmlNode& inertia = made.children.emplace_back(element_at(made, "inertia"));
  for (const char* const moment : {"ixx", "iyy", "izz"}) inertia.children.push_back(element_at(made, moment, "1"));
  return made;
}

// Existing elements of `into` stay.
void merge_into(XmlNode& into, const XmlNode& from) {
  for (const XmlNode& child : from.children) {
    XmlNode* const own = child_of(into, child.name);
    if (own == nullptr)
      into.children.push_back(child);
    else
      merge_into(*own, child);
  }
}

// Returns the name that Gazebo gives a collision or visual of a link, number `index` in the link that carries it.
std::string name_of_part(const UrdfLink& link, const XmlNode& source, const std::string& carrier, std::size_t index) {
  std::string name = value_of(source, "name").empty() ? link.name : value_of(source, "name");
  name += "_" + source.name + (index > 0 ? "_" + std::to_string(index) : "");
  return name.starts_with(carrier) ? name : carrier + std::string(lump_mark) + name;
}

XmlNode geometry_of(const XmlNode& source) {
  XmlNode geometry = element_at(source, "geometry");
  const XmlNode& shape = source.children.front();
  XmlNode& made = geometry.children.emplace_back(element_at(shape, shape.name));
  const auto set = [&](const char* name, const std::string& text) {
    made.children.push_back(element_at(shape, name, text));
  };
  if (shape.name == "mesh") {
    constexpr std::string_view package = "package://";
    const std::string scale = value_of(shape, "scale");
    std::string uri = value_of(shape, "filename");
    if (const std::size_t at = uri.find(package); at != std::string::npos) uri.replace(at, package.size(), "model://");
    set("scale", scale.empty() ? "1 1 1" : scale);
    set("uri", uri);
  } else if (shape.name == "plane") {
    const std::string normal = value_of(shape, "normal");
    set("normal", normal.empty() ? "0 0 1" : normal);
  } else {
    for (const char* const name : {"size", "length", "radius"})
      if (shape.attribute(name) != nullptr) set(name, value_of(shape, name));
  }
  return geometry;
}

}  // namespace

bool has_mass(const UrdfLink& link) {
  return std::ranges::any_of(link.parts(),
                             [](const UrdfLink* part) { return part->node->child("inertial") != nullptr; });
}

bool has_plane(const UrdfLink& link) {
  return std::ranges::any_of(link.node->children, [](const XmlNode& part) {
    return part.name == "collision" && part.child("geometry")->child("plane") != nullptr;
  });
}

XmlNode inertial_of(const UrdfLink& link) {
  std::vector<MassProperties> masses;  // in the frame of the own inertia
  const UrdfLink* first = nullptr;     // a flaw of the sum is one of its parts
  const XmlNode* const own = link.node->child("inertial");
  const Pose X_LI = own != nullptr ? urdf_origin(*own) : Pose{};
  for (const UrdfLink* const part : link.parts()) {
    const XmlNode* const inertial = part->node->child("inertial");
    if (inertial == nullptr) continue;
    const Pose X_IP = X_LI.inverse() * part->in_carrier(urdf_origin(*inertial));
    masses.push_back(
        moved({number_of(*inertial->child("mass"), "value"), Eigen::Vector3d::Zero(), inertia_of(*inertial)}, X_IP));
    if (first == nullptr || (is_possible(*first->node->child("inertial")) && !is_possible(*inertial))) first = part;
  }
  if (first == nullptr) {
    XmlNode made = inertial_without_mass(link);
    made.written = path_in_urdf(link, made);
    return made;
  }
  const XmlNode& source = *first->node->child("inertial");
  std::string mass = value_of(*source.child("mass"), "value");
  std::vector<std::string> texts;
  Pose pose = X_LI;
  if (masses.size() == 1 && first == &link) {
    for (const char* const moment : inertia_names) texts.push_back(value_of(*source.child("inertia"), moment));
  } else {
    const MassProperties sum = together(masses);
    pose.position = X_LI * sum.centre;
    mass = shortest_text(sum.mass);
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column) texts.push_back(shortest_text(sum.inertia(row, column)));
  }
  XmlNode made = inertial_like(source, pose, mass, texts);
  made.written = path_in_urdf(*first, source);
  return made;
}

XmlNode part_of(const UrdfLink& link, const XmlNode& source, std::size_t index) {
  XmlNode part = element_at(source, source.name);
  set_attribute(part, "name", name_of_part(link, source, link.carrier().name, index));
  part.children = {pose_at(source, link.in_carrier(urdf_origin(source))), geometry_of(*source.child("geometry"))};
  part.written = path_in_urdf(link, source);
  return part;
}

void adjust_contact(const UrdfLink& link, const XmlNode& carrier, XmlNode& sensor) {
  XmlNode* const contact = sensor.name == "sensor" ? child_of(sensor, "contact") : nullptr;
  XmlNode* const collision = contact != nullptr ? child_of(*contact, "collision") : nullptr;
  if (collision == nullptr) return;
  std::vector<std::string> names;  // names of its collisions if it were not merged
  for (const XmlNode& source : link.node->children)
    if (source.name == "collision") names.push_back(name_of_part(link, source, link.name, names.size()));
  std::size_t index = 0;
  for (const XmlNode& part : carrier.children) {
    if (part.name != "collision" || !part.written.starts_with("link[" + link.name + "]/")) continue;
    if (names[index++] != collision->text) continue;
    collision->text = value_of(part, "name");
    return;
  }
}

bool belongs_to(const UrdfLink& link, const XmlNode& part) {
  const std::string name = value_of(part, "name");
  return link.is_merged ? name.find(std::string(lump_mark) + link.name + "_" + part.name) != std::string::npos
                        : name.find(lump_mark) == std::string::npos;
}

void add_surface(const UrdfLink& link, XmlNode& collision) {
  const XmlNode* const surface = link.node->child("surface");
  if (surface == nullptr) return;
  if (collision.child("surface") == nullptr) collision.children.push_back(element_at(*surface, "surface"));
  merge_into(*child_of(collision, "surface"), *surface);
}

void add_material(const XmlNode& robot, const XmlNode& source, XmlNode& visual) {
  const XmlNode* written = source.child("material");
  if (written == nullptr) return;
  const std::string name = value_of(*written, "name");
  for (const XmlNode& shared : robot.children)
    if (shared.name == "material" && !name.empty() && value_of(shared, "name") == name) written = &shared;
  const XmlNode* const color = written->child("color");
  if (color == nullptr && written->child("texture") == nullptr) return;
  const std::string rgba = color != nullptr ? value_of(*color, "rgba") : "0 0 0 1";
  std::string bright;  // Gazebo's renderer makes it darker
  const std::vector<std::string_view> channels = words(rgba);
  for (std::size_t i = 0; i < 3; ++i)
    bright += shortest_text(std::clamp(static_cast<float>(*parse_real(channels[i])) / 0.8, 0.0, 1.0)) + " ";
  bright += channels[3];
  XmlNode* material = child_of(visual, "material");
  const XmlNode& where = *source.child("material");
  if (material == nullptr) material = &visual.children.emplace_back(element_at(where, "material"));
  if (material->child("diffuse") != nullptr || material->child("ambient") != nullptr) return;
  for (const char* const light : {"diffuse", "ambient"}) material->children.push_back(element_at(where, light, bright));
}

}  // namespace cohort::parsing
