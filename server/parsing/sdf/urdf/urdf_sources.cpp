#include "server/parsing/sdf/urdf/urdf_sources.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"
#include "server/parsing/sdf/urdf/urdf_masses.hpp"
#include "server/parsing/sdf/urdf/urdf_notes.hpp"

namespace cohort::parsing {
namespace {

constexpr const char* source_mark = "cohort:source";

using NamePairs = std::span<const std::pair<std::string_view, std::string_view>>;

std::string counterpart_of(const std::string& sdf, NamePairs pairs) {
  const auto found = std::ranges::find(pairs, sdf, [](const auto& pair) { return pair.first; });
  return found == pairs.end() ? sdf : std::string(found->second);
}

// Returns the name of the URDF element to which an SDF element corresponds.
std::string urdf_name(const std::string& sdf) {
  constexpr std::pair<std::string_view, std::string_view> names[] = {
      {"pose", "origin"}, {"lower", "limit"}, {"upper", "limit"}, {"damping", "dynamics"}, {"friction", "dynamics"}};
  return counterpart_of(sdf, names);
}

// Returns the name of the element in <gazebo> that sets an SDF element.
std::string gazebo_name(const std::string& sdf) {
  constexpr std::pair<std::string_view, std::string_view> names[] = {{"mu", "mu1"},
                                                                     {"max_vel", "maxVel"},
                                                                     {"min_depth", "minDepth"},
                                                                     {"max_contacts", "maxContacts"},
                                                                     {"laser_retro", "laserRetro"},
                                                                     {"gravity", "turnGravityOff"},
                                                                     {"self_collide", "selfCollide"},
                                                                     {"linear", "dampingFactor"},
                                                                     {"angular", "dampingFactor"},
                                                                     {"cfm", "stopCfm"},
                                                                     {"erp", "stopErp"},
                                                                     {"spring_reference", "springReference"},
                                                                     {"spring_stiffness", "springStiffness"}};
  return counterpart_of(sdf, names);
}

// Returns whether a body can have this inertia. A sum of such inertias is one that a body can have.
bool is_possible(const XmlNode& inertial) {
  const XmlNode* const inertia = inertial.child("inertia");
  if (inertia == nullptr) return true;
  const auto component = [&](const char* name) { return parse_real(value_of(*inertia, name)).value_or(0.0); };
  const double xy = component("ixy"), xz = component("ixz"), yz = component("iyz");
  Eigen::Matrix3d matrix;
  matrix << component("ixx"), xy, xz, xy, component("iyy"), yz, xz, yz, component("izz");
  const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvalues();
  return moments[0] > 0.0 && moments[2] <= (moments[0] + moments[1]) * (1.0 + 1e-6);
}

}  // namespace

UrdfSources::UrdfSources(XmlNode& robot) : robot_(robot) {
  for (XmlNode& child : robot.children) {
    if (child.name == "gazebo")
      for (XmlNode& part : child.children) mark_below(part, value_of(child, "reference"));
    if (child.name == "link") links_.emplace(value_of(child, "name"), &child);
    if (child.name == "joint") joints_.emplace(value_of(child, "name"), &child);
  }
}

void UrdfSources::mark_below(XmlNode& node, const std::string& reference) {
  set_attribute(node, source_mark, std::to_string(marked_.size()));
  marked_.push_back({&node, &node, reference});
  for (XmlNode& child : node.children) mark_below(child, reference);
}

XmlNode UrdfSources::tree(const sdf::ElementPtr& sdf) {
  if (sdf->HasElement("model"))
    for (sdf::ElementPtr link = sdf->GetElement("model")->FindElement("link"); link;
         link = link->GetNextElement("link"))
      kept_.insert(link->GetAttribute("name")->GetAsString());
  return tree(sdf, {&robot_, &robot_, ""});
}

XmlNode UrdfSources::tree(const sdf::ElementPtr& element, const Source& source) const {
  XmlNode node{element->GetName(), source.node->line, nullptr, {}, "", {}};
  for (const sdf::ParamPtr& attribute : element->GetAttributes())
    if (attribute->GetKey() != source_mark) node.attributes.emplace_back(attribute->GetKey(), attribute->GetAsString());
  if (element->GetValue()) node.text = element->GetValue()->GetAsString();
  const auto link = links_.find(source.owner);
  const bool is_link = link != links_.end() && source.node == link->second && element->GetName() == "link";
  std::vector<Source> parts = is_link ? parts_of(source.owner) : std::vector<Source>();
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    const auto part = std::ranges::find(parts, child->GetName(), [](const Source& from) { return from.node->name; });
    const bool is_part = part != parts.end();
    const Source from = is_part ? *part : source_of(child, source);
    if (is_part) parts.erase(part);
    XmlNode& made = node.children.emplace_back(tree(child, from));
    if (is_link && (is_part || from.owner != source.owner))
      made.written = "link[" + from.owner + "]/" + urdf_step(*from.node);
  }
  return node;
}

UrdfSources::Source UrdfSources::source_of(const sdf::ElementPtr& element, const Source& around) const {
  if (element->HasAttribute(source_mark))
    if (const auto index = parse_whole(element->GetAttribute(source_mark)->GetAsString())) return marked_.at(*index);
  const std::string& kind = element->GetName();
  if (around.owner.empty() && (kind == "link" || kind == "joint") && element->HasAttribute("name")) {
    const auto& named = kind == "link" ? links_ : joints_;
    if (const auto found = named.find(element->GetAttribute("name")->GetAsString()); found != named.end())
      return {found->second, found->second, found->first};
  }
  Source source = around;
  for (const XmlNode* const parent : {around.node, around.part})
    if (const XmlNode* const child = parent->child(urdf_name(kind))) {
      source.node = child;
      return source;
    }
  for (const XmlNode& gazebo : robot_.children)
    if (const XmlNode* const child = gazebo.child(gazebo_name(kind));
        child != nullptr && gazebo.name == "gazebo" && value_of(gazebo, "reference") == around.owner)
      source.node = child;
  return source;
}

// libsdformat merges a link after those below it, in the order of the names of their joints.
void UrdfSources::collect_merged(const std::string& link, std::vector<const XmlNode*>& links) const {
  const auto found = links_.find(link);
  if (found == links_.end()) return;
  links.push_back(found->second);
  for (const auto& [name, joint] : joints_)
    if (value_of(*joint, "type") == "fixed" && urdf_end(*joint, "parent") == link &&
        !kept_.contains(urdf_end(*joint, "child")))
      collect_merged(urdf_end(*joint, "child"), links);
}

std::vector<UrdfSources::Source> UrdfSources::parts_of(const std::string& link) const {
  std::vector<const XmlNode*> links;
  collect_merged(link, links);
  std::vector<Source> parts;
  std::optional<Source> inertial;  // a flaw of the sum is one of its parts
  for (const XmlNode* const merged : links)
    for (const XmlNode& part : merged->children) {
      const Source source{&part, &part, value_of(*merged, "name")};
      if (part.name == "collision" || part.name == "visual") parts.push_back(source);
      if (part.name == "inertial" && (!inertial || (is_possible(*inertial->node) && !is_possible(part))))
        inertial = source;
    }
  if (inertial) parts.push_back(*inertial);
  return parts;
}

}  // namespace cohort::parsing
