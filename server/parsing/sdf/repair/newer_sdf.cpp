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
  NewerSdf(const std::filesystem::path& file, std::vector<Problem>& warnings) : file_(file), warnings_(warnings) {}

  void change(XmlNode& node, const std::string& path);

 private:
  void warn(const XmlNode& node, const std::string& path, const std::string& message) {
    warnings_.push_back({file_, node.line, path, message});
  }
  static void change_link(XmlNode& link);
  void change_joint(XmlNode& joint, const std::string& path);
  void change_geometry(XmlNode& geometry, const std::string& path);

  const std::filesystem::path& file_;
  std::vector<Problem>& warnings_;
};

void NewerSdf::change(XmlNode& node, const std::string& path) {
  if (node.name == "link") change_link(node);
  if (node.name == "joint") change_joint(node, path);
  if (node.name == "geometry") change_geometry(node, path);
  if (node.name == "plugin") return;
  for (XmlNode& child : node.children) change(child, (path.empty() ? "" : path + "/") + step_of(child));
}

XmlNode density_from(const XmlNode& where, const std::string& text) {
  return element_at(where, prefixed("density"), text);
}

// `auto`: inertia from the shapes and their densities, as <cohort:density>. A mass beside it scales the inertia.
void NewerSdf::change_link(XmlNode& link) {
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
    const std::optional<std::string> text = density != nullptr ? std::optional(density->text) : std::nullopt;
    std::erase_if(collision.children, [](const XmlNode& child) { return child.name == "density"; });
    if (is_auto && text) collision.children.push_back(density_from(collision, *text));
  }
  if (!is_auto) return;
  const XmlNode* const density = inertial->child("density");
  XmlNode ours = density_from(*inertial, density != nullptr ? density->text : density_of_water);
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

// The position in SDF is multiplier * (leader - reference) + offset. Only first axes can be coupled.
void NewerSdf::change_joint(XmlNode& joint, const std::string& path) {
  set_thread_pitch(joint);
  std::optional<XmlNode> follows;
  for (XmlNode& axis : joint.children) {
    const XmlNode* const mimic = axis.name == "axis" || axis.name == "axis2" ? axis.child("mimic") : nullptr;
    if (mimic == nullptr) continue;
    const bool is_led_by_second = value_of(*mimic, "axis") == "axis2";
    if (axis.name == "axis2" || is_led_by_second) {
      warn(*mimic, path + "/" + axis.name + "/mimic",
           std::string("a <mimic> ") + (is_led_by_second ? "that follows an <axis2>" : "of an <axis2>") +
               " is not supported and is ignored; expected <axis>");
      std::erase_if(axis.children, [](const XmlNode& child) { return child.name == "mimic"; });
      continue;
    }
    const auto number = [&](const char* name, double otherwise) {
      const XmlNode* const child = mimic->child(name);
      return child != nullptr ? parse_real(child->text).value_or(otherwise) : otherwise;
    };
    const double multiplier = number("multiplier", 1.0);
    follows = element_at(*mimic, prefixed("mimic"));
    follows->children = {element_at(*mimic, prefixed("joint"), value_of(*mimic, "joint")),
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

void take_newer(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>& warnings) {
  NewerSdf(file, warnings).change(sdf, "");
}

}  // namespace cohort::parsing
