// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/repair/newer_sdf.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/keys/extensions.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

constexpr const char* density_of_water = "1000";  // SDF's default [kg/m^3]

class NewerSdf {
 public:
  NewerSdf(const std::filesystem::path& file, std::vector<Problem>& problems, std::vector<Problem>& warnings)
      : file_(file), problems_(problems), warnings_(warnings) {}

  void change(XmlNode& node, const std::string& path);

 private:
  void warn(const XmlNode& node, const std::string& path, const std::string& message) {
    warnings_.push_back({file_, node.line, path, message});
  }
  void change_link(XmlNode& link, const std::string& path);
  XmlNode checked_density(const XmlNode& density, const std::string& path);
  void change_joint(XmlNode& joint, const std::string& path);
  void change_geometry(XmlNode& geometry, const std::string& path);

  const std::filesystem::path& file_;
  std::vector<Problem>& problems_;
  std::vector<Problem>& warnings_;
};

void NewerSdf::change(XmlNode& node, const std::string& path) {
  if (node.name == "link") change_link(node, path);
  if (node.name == "joint") change_joint(node, path);
  if (node.name == "geometry") change_geometry(node, path);
  if (node.name == "plugin") return;
  for (XmlNode& child : node.children) change(child, (path.empty() ? "" : path + "/") + step_of(child));
}

XmlNode NewerSdf::checked_density(const XmlNode& density, const std::string& path) {
  const bool is_right = parse_real(density.text).value_or(0.0) > 0.0;
  if (!is_right)
    problems_.push_back(
        {file_, density.line, path + "/density", "expected a density > 0 kg/m^3, not '" + density.text + "'"});
  return element_at(density, prefixed("density"), is_right ? density.text : density_of_water);
}

// `auto`: inertia from the shapes and their densities, as <cohort:density>. A mass beside it scales the inertia.
void NewerSdf::change_link(XmlNode& link, const std::string& path) {
  const XmlNode* const inertial = link.child("inertial");
  const bool is_auto =
      inertial != nullptr && (value_of(*inertial, "auto") == "true" || value_of(*inertial, "auto") == "1");
  if (XmlNode* const written = child_of(link, "inertial"); written != nullptr && !is_auto) {
    std::erase_if(written->attributes, [](const auto& attribute) { return attribute.first == "auto"; });
    std::erase_if(written->children, [](const XmlNode& child) { return child.name == "density"; });
  }
  for (XmlNode& collision : link.children) {
    if (collision.name != "collision") continue;
    const XmlNode* const density = collision.child("density");
    std::optional<XmlNode> ours;
    if (is_auto && density != nullptr) ours = checked_density(*density, path + "/" + step_of(collision));
    std::erase_if(collision.children, [](const XmlNode& child) { return child.name == "density"; });
    if (ours) collision.children.push_back(*std::move(ours));
  }
  if (!is_auto) return;
  const XmlNode* const density = inertial->child("density");
  XmlNode ours = density != nullptr ? checked_density(*density, path + "/inertial")
                                    : element_at(*inertial, prefixed("density"), density_of_water);
  XmlNode& rest = *child_of(link, "inertial");
  rest.attributes.clear();
  std::erase_if(rest.children, [](const XmlNode& child) {
    return child.name == "density" || child.name == "pose" || child.name == "inertia";
  });
  if (rest.children.empty())
    std::erase_if(link.children, [](const XmlNode& child) { return child.name == "inertial"; });
  link.children.push_back(std::move(ours));
}

// <screw_thread_pitch> is the way along the axis in a right-handed turn [m]; <thread_pitch>, which it replaces, is the
// angle of a left-handed thread over the way [rad/m].
void set_thread_pitch(XmlNode& joint) {
  XmlNode* const pitch = child_of(joint, "screw_thread_pitch");
  if (pitch == nullptr) return;
  if (const auto metres = parse_real(pitch->text)) pitch->text = shortest_text(-2.0 * M_PI / *metres);
  std::erase_if(joint.children, [](const XmlNode& child) { return child.name == "thread_pitch"; });
  child_of(joint, "screw_thread_pitch")->name = "thread_pitch";
}

// The position in SDF is multiplier * (leader - reference) + offset. Only one axis of a joint can follow another.
void NewerSdf::change_joint(XmlNode& joint, const std::string& path) {
  set_thread_pitch(joint);
  std::optional<XmlNode> follows;
  for (XmlNode& axis : joint.children) {
    const XmlNode* const mimic = axis.name == "axis" || axis.name == "axis2" ? axis.child("mimic") : nullptr;
    if (mimic == nullptr) continue;
    if (follows) {
      warn(*mimic, path + "/" + axis.name + "/mimic",
           "the joint already has a <mimic>, and only one of its axes can follow; this <mimic> is ignored");
      std::erase_if(axis.children, [](const XmlNode& child) { return child.name == "mimic"; });
      continue;
    }
    const auto number = [&](const char* name, double otherwise) {
      const XmlNode* const child = mimic->child(name);
      return child != nullptr ? parse_real(child->text).value_or(otherwise) : otherwise;
    };
    const double multiplier = number("multiplier", 1.0);
    follows = element_at(*mimic, prefixed("mimic"));
    const std::string followed = value_of(*mimic, "axis");
    follows->children = {element_at(*mimic, prefixed("joint"), value_of(*mimic, "joint")),
                         element_at(*mimic, prefixed("axis"), axis.name),
                         element_at(*mimic, prefixed("followed_axis"), followed.empty() ? "axis" : followed),
                         element_at(*mimic, prefixed("multiplier"), shortest_text(multiplier)),
                         element_at(*mimic, prefixed("offset"),
                                    shortest_text(number("offset", 0.0) - multiplier * number("reference", 0.0)))};
    std::erase_if(axis.children, [](const XmlNode& child) { return child.name == "mimic"; });
  }
  if (follows) joint.children.push_back(*std::move(follows));
}

void NewerSdf::change_geometry(XmlNode& geometry, const std::string& path) {
  XmlNode* const cone = child_of(geometry, "cone");
  if (cone == nullptr) return;
  cone->name = "cylinder";
  if (XmlNode* const radius = child_of(*cone, "radius"))
    if (const auto value = parse_real(radius->text)) radius->text = shortest_text(*value / std::sqrt(3.0));
  warn(*cone, path + "/cone", "a cone is replaced by a cylinder of the same length and volume");
}

}  // namespace

void take_newer(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>& problems,
                std::vector<Problem>& warnings) {
  NewerSdf(file, problems, warnings).change(sdf, "");
}

}  // namespace cohort::parsing
