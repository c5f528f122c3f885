// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string_view>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/urdf/mend_urdf.hpp"
#include "server/parsing/sdf/urdf/urdf_gazebo.hpp"

namespace cohort::parsing {
namespace {

struct SurfaceElement {
  std::string_view name;
  std::string_view path;  ///< below <surface> of SDF
  double factor = 1.0;
};

constexpr SurfaceElement surface_elements[] = {
    {"lateral_friction", "friction/ode/mu"},
    {"rolling_friction", "friction/bullet/rolling_friction"},
    // SDF's torsional friction has the inverse of this factor.
    {"spinning_friction", "friction/torsional/patch_radius", 16.0 / (3.0 * std::numbers::pi)},
    {"restitution", "bounce/restitution_coefficient"},
    {"stiffness", "contact/ode/kp"},
    {"damping", "contact/ode/kd"},
};

}  // namespace

std::optional<XmlNode> surface_of(const XmlNode& contact, const std::string& path, UrdfNotes& notes) {
  XmlNode surface = element_at(contact, "surface");
  for (const XmlNode& child : contact.children) {
    const std::string child_path = path + "/" + child.name;
    const auto found = std::ranges::find(surface_elements, child.name, &SurfaceElement::name);
    if (found == std::end(surface_elements)) {
      notes.pass_over(child, child_path, "ignored the unknown element <" + child.name + "> in <contact>");
      continue;
    }
    const std::optional<double> value = parse_real(value_of(child, "value"));
    if (!value || !std::isfinite(*value) || *value < 0.0) {
      notes.pass_over(child, child_path, "expected value=\"NUMBER\", with a number >= 0; the element is ignored");
      continue;
    }
    if (child.name == "stiffness" && *value == 0.0) continue;
    const double most = child.name == "restitution" ? 1.0 : *value;
    set_at(surface, found->path, shortest_text(found->factor * std::min(*value, most)), child);
  }
  return surface.children.empty() ? std::nullopt : std::optional(std::move(surface));
}

}  // namespace cohort::parsing
