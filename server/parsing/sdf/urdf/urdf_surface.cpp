#include "server/parsing/sdf/urdf/urdf_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

// Adds `text` at a path below `node`.
void put(XmlNode& node, const std::vector<const char*>& path, const std::string& text) {
  XmlNode* at = &node;
  for (const char* const name : path) {
    XmlNode* next = child_of(*at, name);
    if (next == nullptr) next = &at->children.emplace_back(element_at(node, name));
    at = next;
  }
  at->text = text;
}

}  // namespace

std::optional<XmlNode> surface_of(const XmlNode& contact, const std::string& path, UrdfNotes& notes) {
  const double radius_by_spinning = 16.0 / (3.0 * std::numbers::pi);  // SDF's torsional friction has its inverse
  XmlNode surface = element_at(contact, "surface");
  for (const XmlNode& child : contact.children) {
    const std::optional<double> value = parse_real(value_of(child, "value"));
    const bool is_number = value && std::isfinite(*value) && *value >= 0.0;
    const auto set = [&](const std::vector<const char*>& where, double factor = 1.0) {
      if (is_number) put(surface, where, shortest_text(factor * *value));
    };
    if (child.name == "lateral_friction") {
      set({"friction", "ode", "mu"});
    } else if (child.name == "rolling_friction") {
      set({"friction", "bullet", "rolling_friction"});
    } else if (child.name == "spinning_friction") {
      set({"friction", "torsional", "patch_radius"}, radius_by_spinning);
    } else if (child.name == "restitution") {
      if (is_number) put(surface, {"bounce", "restitution_coefficient"}, shortest_text(std::min(*value, 1.0)));
    } else if (child.name == "stiffness") {
      if (value && *value > 0.0) set({"contact", "ode", "kp"});
    } else if (child.name == "damping") {
      set({"contact", "ode", "kd"});
    } else {
      notes.pass_over(child, path + "/" + child.name, "ignored the unknown element <" + child.name + "> in <contact>");
      continue;
    }
    if (!is_number)
      notes.pass_over(child, path + "/" + child.name,
                      "expected value=\"NUMBER\", with a number >= 0; the element is ignored");
  }
  return surface.children.empty() ? std::nullopt : std::optional(std::move(surface));
}

}  // namespace cohort::parsing
