// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/schema/value_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>
#include <vector>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

bool is_flag(std::string_view text) { return is_true(text) || lower_case(text) == "false" || text == "0"; }

bool is_color(const std::vector<std::string_view>& parts) {
  return (parts.size() == 3 || parts.size() == 4) && std::ranges::all_of(parts, [](std::string_view part) {
           const std::optional<double> number = leading_number(part);
           return number && *number >= 0.0 && *number <= 1.0;
         });
}

std::string attribute_or(const XmlNode& node, std::string_view name, std::string_view otherwise) {
  const std::string* const value = node.attribute(name);
  return value != nullptr && !value->empty() ? *value : std::string(otherwise);
}

}  // namespace

std::optional<double> leading_number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() ? std::optional(number) : std::nullopt;
}

long long leading_whole(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const bool is_hexadecimal = text.starts_with("0x") || text.starts_with("0X");
  if (is_hexadecimal) text.remove_prefix(2);
  long long number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number, is_hexadecimal ? 16 : 10);
  return number;
}

bool is_true(std::string_view text) { return text == "1" || lower_case(text) == "true"; }

bool is_standard(const ValueRule& rule, std::string_view text) {
  if (rule.type == ValueType::flag) return is_true(text) == is_true(rule.standard);
  return std::ranges::equal(words(text), words(rule.standard), [](std::string_view written, std::string_view standard) {
    const std::optional<double> number = parse_real(written);
    return number ? number == parse_real(standard) : written == standard;
  });
}

bool allows(const ValueRule& rule, std::string_view text) {
  text = trimmed(text);
  if (rule.type == ValueType::flag) return is_flag(text);
  if (rule.type == ValueType::color) return is_color(words(text));
  const std::size_t count = count_of_numbers(rule.type);
  const std::vector<std::string_view> parts = count > 0 ? words(text) : std::vector<std::string_view>();
  if (parts.size() < count) return false;
  return std::all_of(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count), [&](std::string_view part) {
    const std::optional<double> number = leading_number(part);
    return number && !(*number < rule.least) && !(*number > rule.greatest);
  });
}

bool is_unit(double squared_norm) { return std::abs(squared_norm - 1.0) < 1e-14; }

Eigen::Quaterniond rotation_of(double roll, double pitch, double yaw) {
  const double a = roll / 2.0, b = pitch / 2.0, c = yaw / 2.0;
  double w = std::cos(a) * std::cos(b) * std::cos(c) + std::sin(a) * std::sin(b) * std::sin(c);
  double x = std::sin(a) * std::cos(b) * std::cos(c) - std::cos(a) * std::sin(b) * std::sin(c);
  double y = std::cos(a) * std::sin(b) * std::cos(c) + std::sin(a) * std::cos(b) * std::sin(c);
  double z = std::cos(a) * std::cos(b) * std::sin(c) - std::sin(a) * std::sin(b) * std::cos(c);
  const double norm = std::sqrt(w * w + x * x + y * y + z * z);
  return Eigen::Quaterniond(w / norm, x / norm, y / norm, z / norm).normalized();
}

std::optional<Pose> written_pose(const XmlNode& pose) {
  const std::string format = attribute_or(pose, "rotation_format", "euler_rpy");
  const std::string degrees = attribute_or(pose, "degrees", "false");
  const bool is_quaternion = format == "quat_xyzw";
  if ((!is_quaternion && format != "euler_rpy") || !is_flag(degrees)) return std::nullopt;
  const bool has_degrees = is_true(degrees);
  if (is_quaternion && has_degrees) return std::nullopt;
  const std::vector<std::string_view> parts = words(pose.text);
  if (parts.empty()) return Pose{};
  if (parts.size() != (is_quaternion ? 7 : 6)) return std::nullopt;
  std::array<double, 7> numbers{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::optional<double> number = leading_number(parts[i]);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers[i] = *number;
  }
  Pose read;
  read.position = {numbers[0], numbers[1], numbers[2]};
  if (is_quaternion) {
    const Eigen::Quaterniond written(numbers[6], numbers[3], numbers[4], numbers[5]);
    read.orientation = is_unit(written.squaredNorm()) ? written : written.normalized();
  } else {
    const auto angle = [&](std::size_t i) { return has_degrees ? numbers[i] * M_PI / 180.0 : numbers[i]; };
    read.orientation = rotation_of(angle(3), angle(4), angle(5));
  }
  return read;
}

}  // namespace cohort::parsing
