#include "server/parsing/sdf/urdf/urdf_masses.hpp"

#include <algorithm>
#include <ignition/math/Pose3.hh>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "server/core/text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

std::optional<ignition::math::Vector3d> three_numbers(const std::string& text) {
  const std::vector<std::string_view> parts = words(text);
  if (parts.empty()) return ignition::math::Vector3d::Zero;
  ignition::math::Vector3d numbers;
  if (parts.size() != 3) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> number = parse_real(parts[i]);
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

// Returns the origin; nothing if it cannot be read, which is reported elsewhere.
std::optional<ignition::math::Pose3d> origin_of(const XmlNode& joint) {
  const XmlNode* const origin = joint.child("origin");
  if (origin == nullptr) return ignition::math::Pose3d::Zero;
  const auto position = three_numbers(value_of(*origin, "xyz"));
  const auto turn = three_numbers(value_of(*origin, "rpy"));
  if (!position || !turn) return std::nullopt;
  return ignition::math::Pose3d(position->X(), position->Y(), position->Z(), turn->X(), turn->Y(), turn->Z());
}

void set_origin(XmlNode& joint, const ignition::math::Pose3d& X) {
  XmlNode* origin = child_of(joint, "origin");
  if (origin == nullptr) origin = &joint.children.emplace_back(element_at(joint, "origin"));
  const auto text_of = [](const ignition::math::Vector3d& v) {
    return shortest_text(v.X()) + " " + shortest_text(v.Y()) + " " + shortest_text(v.Z());
  };
  set_attribute(*origin, "xyz", text_of(X.Pos()));
  set_attribute(*origin, "rpy", text_of(X.Rot().Euler()));
}

// Returns the joints for which <gazebo> disables lumping.
std::set<std::string> preserved_joints(const XmlNode& robot) {
  std::set<std::string> preserved;
  for (const XmlNode& gazebo : robot.children) {
    if (gazebo.name != "gazebo") continue;
    for (const char* const name : {"preserveFixedJoint", "disableFixedJointLumping"})
      if (gazebo.child(name) != nullptr) preserved.insert(value_of(gazebo, "reference"));
  }
  return preserved;
}

class Masses {
 public:
  Masses(XmlNode& robot, const std::filesystem::path& file, UrdfRest& rest, std::vector<Problem>& warnings);

  void raise_joints();
  void give_masses();

 private:
  bool is_lumped(const std::string& link) const { return lumped_.contains(link); }
  bool weighs(const std::string& link) const;
  void give_mass(XmlNode& link) const;

  XmlNode& robot_;
  const std::filesystem::path& file_;
  UrdfRest& rest_;
  std::vector<Problem>& warnings_;
  std::map<std::string, XmlNode*> links_;
  std::map<std::string, XmlNode> above_;           // the joint above a link, as the file has it
  std::set<std::string> lumped_;                   // links that become part of the one above
  std::multimap<std::string, std::string> parts_;  // links that are merged into each link
};

Masses::Masses(XmlNode& robot, const std::filesystem::path& file, UrdfRest& rest, std::vector<Problem>& warnings)
    : robot_(robot), file_(file), rest_(rest), warnings_(warnings) {
  const std::set<std::string> preserved = preserved_joints(robot);
  for (XmlNode& child : robot.children) {
    if (child.name == "link") links_.emplace(value_of(child, "name"), &child);
    if (child.name != "joint") continue;
    const std::string parent = urdf_end(child, "parent");
    const std::string link = urdf_end(child, "child");
    above_.emplace(link, child);
    if (value_of(child, "type") != "fixed" || parent == "world" || preserved.contains(value_of(child, "name")))
      continue;
    lumped_.insert(link);
    parts_.emplace(parent, link);
  }
}

// Returns whether a link has mass, including links that are merged into it. A loop of joints is reported elsewhere.
bool Masses::weighs(const std::string& link) const {
  std::set<std::string> met;
  std::vector<std::string> open{link};
  while (!open.empty()) {
    const std::string part = open.back();
    open.pop_back();
    const auto found = links_.find(part);
    if (found == links_.end() || !met.insert(part).second) continue;
    if (has_mass(*found->second)) return true;
    for (auto [at, end] = parts_.equal_range(part); at != end; ++at) open.push_back(at->second);
  }
  return false;
}

// The converter ignores everything below a flange without mass.
void Masses::raise_joints() {
  for (XmlNode& joint : robot_.children) {
    XmlNode* const parent = joint.name == "joint" ? child_of(joint, "parent") : nullptr;
    std::optional<ignition::math::Pose3d> X = origin_of(joint);
    if (parent == nullptr || !X) continue;
    const std::string written = value_of(*parent, "link");
    std::string link = written;
    std::set<std::string> met;
    while (X && is_lumped(link) && met.insert(link).second && !weighs(link)) {
      const XmlNode& flange = above_.at(link);
      const std::optional<ignition::math::Pose3d> X_flange = origin_of(flange);
      X = X_flange ? std::optional(*X_flange * *X) : std::nullopt;
      link = urdf_end(flange, "parent");
    }
    if (link == written || !X || met.contains(link)) continue;
    set_attribute(*parent, "link", link);
    set_origin(joint, *X);
  }
}

void Masses::give_mass(XmlNode& link) const {
  std::erase_if(link.children, [](const XmlNode& child) { return child.name == "inertial"; });
  XmlNode inertial = element_at(link, "inertial");
  XmlNode mass = element_at(link, "mass");
  mass.attributes = {{"value", "1"}};
  XmlNode inertia = element_at(link, "inertia");
  inertia.attributes = {{"ixx", "1"}, {"ixy", "0"}, {"ixz", "0"}, {"iyy", "1"}, {"iyz", "0"}, {"izz", "1"}};
  inertial.children = {std::move(mass), std::move(inertia)};
  link.children.push_back(std::move(inertial));
}

// In URDF, as in Bullet, a root without mass is fixed to the world. Its mass has no effect then.
void Masses::give_masses() {
  for (const auto& [name, link] : links_) {
    if (name == "world" || is_lumped(name) || weighs(name)) continue;
    const auto joint = above_.find(name);
    const bool is_root = joint == above_.end();
    give_mass(*link);
    if (is_root) {
      rest_.held = name;
      warnings_.push_back(
          {file_, link->line, "robot/link[" + name + "]", "is a root link without mass and is fixed to the world"});
    } else if (value_of(joint->second, "type") != "fixed" || urdf_end(joint->second, "parent") != "world") {
      rest_.weightless.insert(name);
    }
  }
}

}  // namespace

std::string urdf_end(const XmlNode& joint, const char* end) {
  const XmlNode* const node = joint.child(end);
  return node != nullptr ? value_of(*node, "link") : "";
}

bool has_mass(const XmlNode& link) {
  const XmlNode* const inertial = link.child("inertial");
  const XmlNode* const mass = inertial != nullptr ? inertial->child("mass") : nullptr;
  return inertial != nullptr && (mass == nullptr || parse_real(value_of(*mass, "value")) != 0.0);
}

void keep_links_without_mass(XmlNode& robot, const std::filesystem::path& file, UrdfRest& rest,
                             std::vector<Problem>& warnings) {
  Masses masses(robot, file, rest, warnings);
  masses.raise_joints();
  masses.give_masses();
}

}  // namespace cohort::parsing
