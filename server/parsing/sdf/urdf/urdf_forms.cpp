// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/urdf/urdf_forms.hpp"

#include <algorithm>
#include <cmath>

#include "server/core/angle.hpp"
#include "server/core/text.hpp"

namespace cohort::parsing {

const std::vector<UrdfForm>& urdf_forms() {
  static const std::vector<UrdfForm> all = {
      {"robot", "origin", {{"xyz", 3}, {"rpy", 3}}},
      {"robot", "link", {{"name", 0, true}}},
      {"robot", "joint", {{"name", 0, true}, {"type", 0, true}}},
      {"robot", "material", {{"name", 0, true}}},
      {"robot", "gazebo", {{"reference"}}},
      {"robot", "transmission", {}, false},
      {"link", "inertial"},
      {"inertial", "origin", {{"xyz", 3}, {"rpy", 3}}},
      {"inertial", "mass", {{"value", 1, true}}},
      {"inertial",
       "inertia",
       {{"ixx", 1, true}, {"ixy", 1, true}, {"ixz", 1, true}, {"iyy", 1, true}, {"iyz", 1, true}, {"izz", 1, true}}},
      {"link", "visual", {{"name"}}},
      {"visual", "origin", {{"xyz", 3}, {"rpy", 3}}},
      {"visual", "geometry"},
      {"visual", "material", {{"name"}}},
      {"material", "color", {{"rgba", 4, true}}},
      {"material", "texture", {{"filename", 0, true}}},
      {"link", "collision", {{"name"}}},
      {"collision", "origin", {{"xyz", 3}, {"rpy", 3}}},
      {"collision", "geometry"},
      {"geometry", "box", {{"size", 3, true, true}}},
      {"geometry", "sphere", {{"radius", 1, true, true}}},
      {"geometry", "cylinder", {{"radius", 1, true, true}, {"length", 1, true, true}}},
      {"geometry", "capsule", {{"radius", 1, true, true}, {"length", 1, true, true}}},
      {"geometry", "plane", {{"normal", 3}}},
      {"geometry", "mesh", {{"filename", 0, true}, {"scale", 3}}},
      {"joint", "origin", {{"xyz", 3}, {"rpy", 3}}},
      {"joint", "parent", {{"link", 0, true}}},
      {"joint", "child", {{"link", 0, true}}},
      {"joint", "axis", {{"xyz", 3}}},
      {"joint", "limit", {{"lower", 1}, {"upper", 1}, {"effort", 1, true}, {"velocity", 1, true}}},
      {"joint", "dynamics", {{"damping", 1}, {"friction", 1}}},
      {"joint", "mimic", {{"joint", 0, true}, {"multiplier", 1}, {"offset", 1}}},
      {"joint", "calibration", {{"rising", 1}, {"falling", 1}, {"reference_position", 1}}, false},
      {"joint",
       "safety_controller",
       {{"soft_lower_limit", 1}, {"soft_upper_limit", 1}, {"k_position", 1}, {"k_velocity", 1}},
       false},
  };
  return all;
}

const UrdfForm* form_of(std::string_view parent, std::string_view name) {
  const auto found = std::ranges::find_if(
      urdf_forms(), [&](const UrdfForm& form) { return form.parent == parent && form.name == name; });
  return found == urdf_forms().end() ? nullptr : &*found;
}

std::optional<std::string> what_is_wrong(const std::string& value, const UrdfAttribute& attribute) {
  const std::string name(attribute.name);
  if (attribute.numbers == 0)
    return value.empty() ? std::optional("expected a value for '" + name + "'") : std::nullopt;
  const std::vector<std::string_view> parts = words(value);
  const bool is_right = std::all_of(parts.begin(), parts.end(), [&](std::string_view part) {
    const std::optional<double> number = parse_real(part);
    return number && std::isfinite(*number) && (!attribute.positive || *number > 0.0);
  });
  const bool has_angles = attribute.name == "rpy";
  const bool is_in_range = !has_angles || std::ranges::all_of(parts, [](std::string_view part) {
    return is_angle(parse_real(part).value_or(0.0));
  });
  if (parts.size() == attribute.numbers && is_right && is_in_range) return std::nullopt;
  return "expected " +
         (attribute.numbers == 1 ? std::string("a number") : std::to_string(attribute.numbers) + " numbers") +
         (attribute.positive ? " > 0" : "") + (has_angles ? std::string(" ") + angle_range : "") + " for '" + name +
         "', not '" + value + "'";
}

}  // namespace cohort::parsing
