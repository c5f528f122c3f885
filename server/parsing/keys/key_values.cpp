// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/keys/key_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "server/core/angle.hpp"
#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

constexpr std::uint64_t greatest_count = 1'000'000;

template <std::size_t count>
std::optional<std::array<double, count>> finite_numbers(std::string_view text) {
  const std::vector<std::string_view> parts = words(text);
  std::array<double, count> numbers{};
  if (parts.size() != count) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> number = parse_real(parts[i]);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

Pose pose_of(const std::array<double, 6>& v) {
  const auto about = [](double angle, const Eigen::Vector3d& axis) { return Eigen::AngleAxisd(angle, axis); };
  return {{v[0], v[1], v[2]},
          Eigen::Quaterniond(about(v[5], Eigen::Vector3d::UnitZ()) * about(v[4], Eigen::Vector3d::UnitY()) *
                             about(v[3], Eigen::Vector3d::UnitX()))};
}

// Normalises the quaternion only if needed, so that a normalised one stays unchanged.
std::optional<Pose> pose_of_quaternion(const std::array<double, 7>& v) {
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  constexpr double no_direction = 1e-6;
  constexpr double rounding = 1e-14;
  if (q.norm() < no_direction || !std::isfinite(q.norm())) return std::nullopt;
  return Pose{{v[0], v[1], v[2]}, std::abs(q.squaredNorm() - 1.0) < rounding ? q : q.normalized()};
}

// Returns whether a text of numbers has an angle that is out of range.
bool has_wrong_angle(std::string_view text, const ExtensionKey& key) {
  std::vector<std::string_view> angles = words(text);
  std::size_t others = angles.size();
  if (key.value == ExtensionValue::pose && angles.size() == 6) others = 3;
  if (key.value == ExtensionValue::place && angles.size() == 3) others = 2;
  if (key.unit == "rad") others = 0;
  angles.erase(angles.begin(), angles.begin() + static_cast<std::ptrdiff_t>(others));
  return std::ranges::any_of(angles, [](std::string_view angle) {
    const std::optional<double> number = parse_real(angle);
    return number && std::isfinite(*number) && !is_angle(*number);
  });
}

bool is_in_range(double number, ExtensionValue kind) {
  switch (kind) {
    case ExtensionValue::non_negative: return number >= 0.0;
    case ExtensionValue::positive: return number > 0.0;
    case ExtensionValue::fraction: return number >= 0.0 && number <= 1.0;
    default: return true;
  }
}

}  // namespace

void KeyValues::prefix_texts(std::string_view key, const std::string& prefix) {
  if (const auto values = values_.find(key); values != values_.end())
    for (Value& value : values->second) std::get<std::string>(value).insert(0, prefix);
}

// NOLINTNEXTLINE(readability-function-cognitive-complexity): one short case for each kind of value.
std::optional<KeyValues::Value> parse_value(std::string_view text, const ExtensionKey& key) {
  using Value = KeyValues::Value;
  if (has_wrong_angle(text, key)) return std::nullopt;
  switch (key.value) {
    case ExtensionValue::name:
    case ExtensionValue::object:
    case ExtensionValue::uri:
      if (text.empty()) return std::nullopt;
      return Value(std::string(text));
    case ExtensionValue::choice:
      for (const std::string_view choice : key.choices)
        if (text == choice) return Value(std::string(text));
      return std::nullopt;
    case ExtensionValue::flag:
      if (text == "true") return Value(true);
      if (text == "false") return Value(false);
      return std::nullopt;
    case ExtensionValue::real:
    case ExtensionValue::non_negative:
    case ExtensionValue::positive:
    case ExtensionValue::fraction: {
      const std::optional<double> number = parse_real(text);
      if (!number || !std::isfinite(*number) || !is_in_range(*number, key.value)) return std::nullopt;
      return Value(*number);
    }
    case ExtensionValue::count:
    case ExtensionValue::whole: {
      const std::optional<std::uint64_t> number = parse_whole(text);
      const bool is_count = number && *number >= 1 && *number <= greatest_count;
      if (!number || (key.value == ExtensionValue::count && !is_count)) return std::nullopt;
      return Value(*number);
    }
    case ExtensionValue::point: {
      const auto numbers = finite_numbers<2>(text);
      if (!numbers) return std::nullopt;
      return Value(Eigen::Vector2d((*numbers)[0], (*numbers)[1]));
    }
    case ExtensionValue::vector:
    case ExtensionValue::place: {
      const auto numbers = finite_numbers<3>(text);
      if (!numbers) return std::nullopt;
      return Value(Eigen::Vector3d((*numbers)[0], (*numbers)[1], (*numbers)[2]));
    }
    case ExtensionValue::pose: {
      if (const auto numbers = finite_numbers<6>(text)) return Value(pose_of(*numbers));
      const auto numbers = finite_numbers<7>(text);
      if (!numbers) return std::nullopt;
      const std::optional<Pose> pose = pose_of_quaternion(*numbers);
      if (!pose) return std::nullopt;
      return Value(*pose);
    }
    case ExtensionValue::group: break;
  }
  return std::nullopt;
}

std::string expected(const ExtensionKey& key) {
  switch (key.value) {
    case ExtensionValue::name:
    case ExtensionValue::object: return "a name";
    case ExtensionValue::uri: return "model://NAME or a path";
    case ExtensionValue::choice: {
      std::string list;
      for (const std::string_view choice : key.choices) list += (list.empty() ? "" : ", ") + std::string(choice);
      return "one of " + list;
    }
    case ExtensionValue::flag: return "true or false";
    case ExtensionValue::real: return "a number";
    case ExtensionValue::non_negative: return "a number >= 0";
    case ExtensionValue::positive: return "a number > 0";
    case ExtensionValue::fraction: return "a number from 0 to 1";
    case ExtensionValue::count: return "a whole number from 1 to " + std::to_string(greatest_count);
    case ExtensionValue::whole: return "a whole number >= 0";
    case ExtensionValue::point: return "two numbers 'x y'";
    case ExtensionValue::vector: return "three numbers 'x y z'";
    case ExtensionValue::place: return "three numbers 'x y heading'";
    case ExtensionValue::pose: return "six numbers 'x y z roll pitch yaw', or seven 'x y z qx qy qz qw'";
    case ExtensionValue::group: return "elements";
  }
  return {};
}

std::string why_wrong(std::string_view text, const ExtensionKey& key) {
  if (text.empty()) return "expected " + expected(key);
  if (key.value == ExtensionValue::choice)
    return "unknown value '" + std::string(text) + "'" + suggestion(text, {key.choices.begin(), key.choices.end()});
  const std::string range = has_wrong_angle(text, key) ? std::string("; angles must be ") + angle_range : "";
  return "expected " + expected(key) + ", not '" + std::string(text) + "'" + range;
}

}  // namespace cohort::parsing
