// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/urdf/urdf_pose.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string_view>
#include <vector>

#include "server/core/text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

Eigen::Quaterniond turn_of(const Eigen::Vector3d& rpy) {
  const Eigen::Array3d half = 0.5 * rpy;
  const Eigen::Array3d c = half.unaryExpr([](double angle) { return std::cos(angle); });
  const Eigen::Array3d s = half.unaryExpr([](double angle) { return std::sin(angle); });
  return Eigen::Quaterniond(c[0] * c[1] * c[2] + s[0] * s[1] * s[2], s[0] * c[1] * c[2] - c[0] * s[1] * s[2],
                            c[0] * s[1] * c[2] + s[0] * c[1] * s[2], c[0] * c[1] * s[2] - s[0] * s[1] * c[2])
      .normalized();
}

Eigen::Vector3d roll_pitch_yaw(const Eigen::Quaterniond& q) {
  const double sine = 2.0 * (q.w() * q.y() - q.x() * q.z());  // sine of the pitch
  const double pitch = std::asin(std::clamp(sine, -1.0, 1.0));
  const double xx = q.x() * q.x(), yy = q.y() * q.y(), zz = q.z() * q.z(), ww = q.w() * q.w();
  constexpr double rounding = 1e-15;
  if (1.0 - std::abs(sine) < rounding)  // only the sum or the difference of roll and yaw is defined
    return {std::copysign(1.0, sine) * std::atan2(2.0 * (q.x() * q.y() - q.z() * q.w()), ww - xx + yy - zz), pitch,
            0.0};
  return {std::atan2(2.0 * (q.y() * q.z() + q.w() * q.x()), ww - xx - yy + zz), pitch,
          std::atan2(2.0 * (q.x() * q.y() + q.w() * q.z()), ww + xx - yy - zz)};
}

std::string text_of_number(double number) {
  constexpr int digits = 16;
  if (number == 0.0) return "0";  // not -0
  char text[32];
  return {std::begin(text),
          std::to_chars(std::begin(text), std::end(text), number, std::chars_format::general, digits).ptr};
}

}  // namespace

Pose urdf_origin(const XmlNode& node) {
  const XmlNode* const origin = node.child("origin");
  if (origin == nullptr) return {};
  const auto text = [&](const char* part) {
    const std::string value = value_of(*origin, part);
    return value.empty() ? std::string("0 0 0") : value;
  };
  return pose_of_text(text("xyz") + " " + text("rpy")).value_or(Pose{});
}

std::optional<Pose> pose_of_text(const std::string& text) {
  const std::vector<std::string_view> parts = words(text);
  if (parts.empty()) return Pose{};
  if (parts.size() != 6) return std::nullopt;
  std::array<double, 6> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::optional<double> number = parse_real(parts[i]);
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  return Pose{{numbers[0], numbers[1], numbers[2]}, turn_of({numbers[3], numbers[4], numbers[5]})};
}

XmlNode pose_at(const XmlNode& source, const Pose& pose) {
  const XmlNode* const origin = source.child("origin");
  return element_at(origin != nullptr ? *origin : source, "pose", text_of_pose(pose));
}

std::string text_of_pose(const Pose& pose) {
  const Eigen::Vector3d rpy = roll_pitch_yaw(pose.orientation);
  std::string text;
  for (const Eigen::Vector3d& part : {pose.position, rpy})
    for (const double number : part) text += (text.empty() ? "" : " ") + text_of_number(number);
  return text;
}

}  // namespace cohort::parsing
