// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/core/text.hpp"
#include "server/parsing/files/sdf_version.hpp"
#include "server/parsing/keys/extensions.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"
#include "server/parsing/sdf/urdf/mend_urdf.hpp"
#include "server/parsing/sdf/urdf/urdf_file.hpp"
#include "server/parsing/sdf/urdf/urdf_gazebo.hpp"
#include "server/parsing/sdf/urdf/urdf_parts.hpp"
#include "server/parsing/sdf/urdf/urdf_pose.hpp"
#include "server/parsing/sdf/urdf/urdf_tree.hpp"

namespace cohort::parsing {
namespace {

/// Makes <model> of SDF from a mended URDF without errors, as Gazebo makes it: links that fixed joints connect become
/// one link. Every element has the line of its source in the URDF; parts of links have `written`.
class UrdfConverter {
 public:
  UrdfConverter(const XmlNode& robot, const std::filesystem::path& file, std::vector<Problem>& warnings)
      : robot_(robot), file_(file), warnings_(warnings), tree_(robot) {}

  XmlNode convert();

 private:
  void warn(const UrdfLink& link, const std::string& message) {
    warnings_.push_back({file_, link.node->line, "robot/link[" + link.name + "]", message});
  }
  /// Adds a link with its joint, and everything below it.
  void add(const UrdfLink& link);
  XmlNode joint_of(const UrdfLink& link) const;
  XmlNode axis_of(const XmlNode& joint) const;
  XmlNode link_of(const UrdfLink& link) const;
  void add_collisions_and_visuals(const UrdfLink& link, XmlNode& node) const;
  /// Adds what <gazebo> blocks of any of the links, and materials and surfaces, say of a collision or visual of
  /// `owner`.
  void complete_part(const std::vector<const UrdfLink*>& links, const UrdfLink& owner, const XmlNode& source,
                     GazeboTarget target, XmlNode& part) const;
  void warn_of_lost_properties(const UrdfLink& owner, const XmlNode& source, const XmlNode& part) const;
  void add_blocks(const UrdfLink& link, XmlNode& node) const;
  /// Returns an element of SDF in a <gazebo> block for use in a link that others are merged with.
  XmlNode adjusted(XmlNode element) const;
  void hold_root();
  /// Returns whether an element in a <gazebo> block is a joint with the name of another one, which is reported.
  bool is_taken(const XmlNode& element);

  const XmlNode& robot_;
  const std::filesystem::path& file_;
  std::vector<Problem>& warnings_;
  const UrdfTree tree_;
  XmlNode model_;
};

// Returns the pose of a joint in the link above it.
XmlNode pose_above(const UrdfLink& link) {
  XmlNode pose = pose_at(*link.joint, link.parent->in_carrier(urdf_origin(*link.joint)));
  set_attribute(pose, "relative_to", link.parent->is_world() ? "__model__" : link.parent->carrier().name);
  return pose;
}

// Moves an element of a link that is merged with another one.
void move_with(const UrdfLink& link, XmlNode& element) {
  std::string name = "pose";
  if (element.name.starts_with(prefixed(""))) {
    const Extension* const extension = find_extension(element.name.substr(prefixed("").size()), "link");
    if (extension == nullptr ||
        std::ranges::find(extension->keys, "pose", &ExtensionKey::name) == extension->keys.end())
      return;
    name = prefixed("pose");
  } else if (element.name != "sensor" && element.name != "light" && element.name != "projector") {
    return;
  }
  const XmlNode* const old = element.child(name);
  const std::optional<Pose> pose = old != nullptr ? pose_of_text(old->text) : Pose{};
  if (!pose || (old != nullptr && old->attribute("relative_to") != nullptr)) return;
  set_at(element, name, text_of_pose(link.in_carrier(*pose)), old != nullptr ? *old : element);
}

XmlNode UrdfConverter::convert() {
  model_ = element_at(robot_, "model");
  set_attribute(model_, "name", value_of(robot_, "name"));
  add(tree_.root());
  for (const XmlNode* const block : tree_.blocks("")) {
    set_gazebo_properties(*block, GazeboTarget::robot, model_);
    for (const XmlNode& child : block->children)
      if (!is_gazebo_property(child.name) && !is_taken(child)) model_.children.push_back(adjusted(child));
  }
  if (const XmlNode* const origin = robot_.child("origin"))
    model_.children.push_back(element_at(*origin, "pose", text_of_pose(urdf_origin(robot_))));
  if (tree_.root().is_world()) {
    if (tree_.root().node->child("collision") != nullptr)
      warn(tree_.root(), "the link 'world' is treated as the world; its collisions are ignored");
  } else if (!has_mass(tree_.root())) {
    hold_root();
  }
  return std::move(model_);
}

bool UrdfConverter::is_taken(const XmlNode& element) {
  const std::string name = value_of(element, "name");
  const bool is_again = element.name == "joint" && std::ranges::any_of(model_.children, [&](const XmlNode& other) {
                          return other.name == "joint" && value_of(other, "name") == name;
                        });
  if (is_again)
    warnings_.push_back({file_, element.line, "robot/gazebo/" + path_step("joint", name),
                         "another joint has this name; the joint in <gazebo> is ignored"});
  return is_again;
}

// In URDF, as in Bullet, a root without mass is fixed to the world. One that has a plane is the ground.
void UrdfConverter::hold_root() {
  const UrdfLink& root = tree_.root();
  warn(root, "is a root link without mass and is fixed to the world");
  const bool is_ground = std::ranges::any_of(root.parts(), [](const UrdfLink* part) { return has_plane(*part); });
  if (is_ground && model_.child("joint") == nullptr) {
    set_at(model_, "static", "true", robot_);
    return;
  }
  XmlNode joint = element_at(robot_, "joint");
  joint.attributes = {{"name", root.name + "_to_world"}, {"type", "fixed"}};
  joint.children = {element_at(robot_, "parent", "world"), element_at(robot_, "child", root.name)};
  model_.children.push_back(std::move(joint));
}

void UrdfConverter::add(const UrdfLink& link) {
  if (!link.is_merged && !link.is_world()) {
    if (link.joint != nullptr && value_of(*link.joint, "type") != "floating") model_.children.push_back(joint_of(link));
    model_.children.push_back(link_of(link));
  }
  for (const UrdfLink* const below : link.below) add(*below);
}

XmlNode UrdfConverter::joint_of(const UrdfLink& link) const {
  const XmlNode& joint = *link.joint;
  const std::string name = value_of(joint, "name");
  const std::string type = value_of(joint, "type");
  const bool is_stiff =
      type == "fixed" && !tree_.is_set(name, "preserveFixedJoint") && tree_.is_set(name, "disableFixedJointLumping");
  XmlNode made = element_at(joint, "joint");
  made.attributes = {{"type", type == "spherical"                ? "ball"
                              : is_stiff || type == "continuous" ? "revolute"
                                                                 : type},
                     {"name", name}};
  made.children = {pose_above(link), element_at(*joint.child("parent"), "parent", link.parent->carrier().name),
                   element_at(*joint.child("child"), "child", link.name)};
  if (is_stiff) {
    set_at(made, "axis/limit/lower", "0", joint);
    set_at(made, "axis/limit/upper", "0", joint);
  } else if (type != "fixed" && type != "spherical") {
    made.children.push_back(axis_of(joint));
  }
  for (const XmlNode* const block : tree_.blocks(name)) {
    set_gazebo_properties(*block, GazeboTarget::joint, made);
    for (const XmlNode& child : block->children)
      if (!is_gazebo_property(child.name)) made.children.push_back(child);
  }
  if (const XmlNode* const mimic = joint.child("mimic")) {
    XmlNode& coupling = made.children.emplace_back(element_at(*mimic, prefixed("mimic")));
    for (const auto& [key, value] : mimic->attributes)
      coupling.children.push_back(element_at(*mimic, prefixed(key), value));
  }
  return made;
}

XmlNode UrdfConverter::axis_of(const XmlNode& joint) const {
  const XmlNode* const direction = joint.child("axis");
  XmlNode axis = element_at(direction != nullptr ? *direction : joint, "axis");
  const std::string xyz = direction != nullptr ? value_of(*direction, "xyz") : "";
  axis.children.push_back(element_at(axis, "xyz", xyz.empty() ? "1 0 0" : xyz));
  const auto set = [&](const std::string& name, const XmlNode& source, const std::string& text) {
    set_at(axis, name, text.empty() ? "0" : text, source);
  };
  if (const XmlNode* const limit = joint.child("limit")) {
    std::string lower = value_of(*limit, "lower"), upper = value_of(*limit, "upper");
    if (parse_real(lower).value_or(0.0) > parse_real(upper).value_or(0.0)) std::swap(lower, upper);
    if (value_of(joint, "type") != "continuous") {
      set("limit/lower", *limit, lower);
      set("limit/upper", *limit, upper);
    }
    for (const char* const name : {"effort", "velocity"})
      set(std::string("limit/") + name, *limit, value_of(*limit, name));
  }
  if (const XmlNode* const dynamics = joint.child("dynamics"))
    for (const char* const name : {"damping", "friction"})
      set(std::string("dynamics/") + name, *dynamics, value_of(*dynamics, name));
  return axis;
}

XmlNode UrdfConverter::link_of(const UrdfLink& link) const {
  XmlNode node = element_at(*link.node, "link");
  set_attribute(node, "name", link.name);
  if (link.joint != nullptr && value_of(*link.joint, "type") == "floating") {
    node.children.push_back(pose_above(link));
  } else if (link.joint != nullptr) {
    node.children.push_back(element_at(node, "pose"));
    set_attribute(node.children.back(), "relative_to", value_of(*link.joint, "name"));
  }
  node.children.push_back(inertial_of(link));
  add_collisions_and_visuals(link, node);
  add_blocks(link, node);
  return node;
}

void UrdfConverter::add_collisions_and_visuals(const UrdfLink& link, XmlNode& node) const {
  std::vector<const UrdfLink*> referred = link.parts();
  std::erase_if(referred, [&](const UrdfLink* part) { return tree_.blocks(part->name).empty(); });
  for (const GazeboTarget target : {GazeboTarget::collision, GazeboTarget::visual}) {
    std::size_t count = 0;
    for (const UrdfLink* const owner : link.parts())
      for (const XmlNode& source : owner->node->children) {
        if (source.name != (target == GazeboTarget::collision ? "collision" : "visual")) continue;
        complete_part(referred, *owner, source, target, node.children.emplace_back(part_of(*owner, source, count++)));
      }
  }
}

void UrdfConverter::complete_part(const std::vector<const UrdfLink*>& links, const UrdfLink& owner,
                                  const XmlNode& source, GazeboTarget target, XmlNode& part) const {
  for (const UrdfLink* const named : links)
    if (belongs_to(*named, part))
      for (const XmlNode* const block : tree_.blocks(named->name)) set_gazebo_properties(*block, target, part);
  if (target == GazeboTarget::collision) {
    warn_of_lost_properties(owner, source, part);
    add_surface(owner, part);
  } else {
    add_material(robot_, source, part);
  }
}

void UrdfConverter::warn_of_lost_properties(const UrdfLink& owner, const XmlNode& source, const XmlNode& part) const {
  if (belongs_to(owner, part)) return;
  XmlNode properties;
  for (const XmlNode* const block : tree_.blocks(owner.name))
    set_gazebo_properties(*block, GazeboTarget::collision, properties);
  if (properties.children.empty()) return;
  warnings_.push_back({file_, source.line, "robot/link[" + owner.name + "]/" + urdf_step(source),
                       "<gazebo reference=\"" + owner.name +
                           "\"> has no effect on it, as in Gazebo, since it has a name of "
                           "its own; remove its name"});
}

void UrdfConverter::add_blocks(const UrdfLink& link, XmlNode& node) const {
  for (const UrdfLink* const owner : link.parts())
    for (const XmlNode* const block : tree_.blocks(owner->name)) {
      set_gazebo_properties(*block, GazeboTarget::link, node);
      for (const XmlNode& child : block->children) {
        if (is_gazebo_property(child.name)) continue;
        XmlNode added = adjusted(child);
        if (owner != &link) {
          move_with(*owner, added);
          adjust_contact(*owner, node, added);
          added.written = "link[" + owner->name + "]/" + path_step(child.name, value_of(child, "name"));
        }
        node.children.push_back(std::move(added));
      }
    }
}

// A joint can refer to a link that is merged with another one. SDF has its pose in the frame of its child.
XmlNode UrdfConverter::adjusted(XmlNode element) const {
  if (element.name != "joint") return element;
  for (const char* const end : {"parent", "child"}) {
    XmlNode* const node = child_of(element, end);
    const UrdfLink* const link = node != nullptr ? tree_.find(node->text) : nullptr;
    if (link == nullptr || !link->is_merged) continue;
    node->text = link->carrier().name;
    const XmlNode* const old = element.child("pose");
    const std::optional<Pose> pose = old != nullptr ? pose_of_text(old->text) : Pose{};
    if (end == std::string_view("child") && pose && (old == nullptr || old->attribute("relative_to") == nullptr))
      set_at(element, "pose", text_of_pose(link->in_carrier(*pose)), old != nullptr ? *old : element);
  }
  return element;
}

}  // namespace

std::optional<XmlNode> sdf_of_urdf(XmlNode robot, const std::filesystem::path& file, std::vector<Problem>& problems,
                                   std::vector<Problem>& warnings) {
  const std::size_t before = problems.size();
  mend_urdf(robot, file, problems, warnings);
  check_urdf(robot, file, problems, warnings);
  if (problems.size() > before) return std::nullopt;
  XmlNode sdf = element_at(robot, "sdf");
  sdf.attributes = {{"version", std::string(converted_version)}, {"xmlns:cohort", "https://cohort-sim.org/sdf/1"}};
  sdf.children.push_back(UrdfConverter(robot, file, warnings).convert());
  return sdf;
}

}  // namespace cohort::parsing
