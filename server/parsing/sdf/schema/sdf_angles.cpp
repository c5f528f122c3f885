// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/schema/sdf_angles.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "server/core/angle.hpp"
#include "server/core/text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

constexpr std::string_view elements_with_angles[] = {"custom_rpy",     "min_angle",   "max_angle",
                                                     "horizontal_fov", "inner_angle", "outer_angle"};

// Returns the last numbers in the text of an element, those of the rotation if it is a pose.
std::vector<double> rotation_in(const XmlNode& node) {
  constexpr std::size_t of_position = 3;
  std::vector<double> numbers;
  for (const std::string_view word : words(node.text)) numbers.push_back(parse_real(word).value_or(0.0));
  const std::size_t others = node.name == "pose" ? std::min(numbers.size(), of_position) : 0;
  numbers.erase(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(others));
  return numbers;
}

bool is_too_great(double angle, double unit) { return std::isfinite(angle) && !is_angle(angle * unit); }

}  // namespace

std::optional<std::string> flaw_of_angles(const XmlNode& node) {
  const bool is_pose = node.name == "pose";
  if (!is_pose && std::ranges::find(elements_with_angles, node.name) == std::end(elements_with_angles))
    return std::nullopt;
  const std::vector<double> numbers = rotation_in(node);
  const bool is_quaternion = is_pose && value_of(node, "rotation_format") == "quat_xyzw";
  const std::string degrees = value_of(node, "degrees");
  const double unit = is_pose && !is_quaternion && (degrees == "true" || degrees == "1") ? M_PI / 180.0 : 1.0;
  if (std::ranges::none_of(numbers, [&](double number) { return is_too_great(number, unit); })) return std::nullopt;
  if (is_quaternion) return "expected a unit quaternion, not '" + node.text + "'";
  return std::string("expected angles ") + angle_range + ", not '" + node.text + "'";
}

}  // namespace cohort::parsing
