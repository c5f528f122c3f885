// SPDX-License-Identifier: Apache-2.0
#include "tools/common/drawing/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace cohort::tool::svg {
namespace {

double distance_to_segment(const Eigen::Vector2d& point, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double squared_length = along.squaredNorm();
  const double t = squared_length > 0.0 ? std::clamp((point - a).dot(along) / squared_length, 0.0, 1.0) : 0.0;
  return (point - a - t * along).norm();
}

// Converts OKLCH to gamma-encoded sRGB, 0 to 1; empty for a colour outside of sRGB.
std::optional<std::array<double, 3>> srgb(double lightness, double chroma, double hue) {
  const double a = chroma * std::cos(2.0 * std::numbers::pi * hue);
  const double b = chroma * std::sin(2.0 * std::numbers::pi * hue);
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  std::array<double, 3> channels = {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                                    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                                    -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
  constexpr double rounding = 1e-4;  // approximate rounding error of the published matrices
  for (double& channel : channels) {
    if (channel < -rounding || channel > 1.0 + rounding) return std::nullopt;
    channel = std::clamp(channel, 0.0, 1.0);
    channel = channel <= 0.0031308 ? 12.92 * channel : 1.055 * std::pow(channel, 1.0 / 2.4) - 0.055;
  }
  return channels;
}

long tenths(double value) { return std::lround(10.0 * value); }

// Returns a number without redundant digits: 0.3 is `.3`.
std::string tenths_text(long value) {
  const long whole = std::abs(value) / 10;
  const long rest = std::abs(value) % 10;
  std::string text = value < 0 ? "-" : "";
  if (whole != 0 || rest == 0) text += std::to_string(whole);
  if (rest != 0) text += "." + std::to_string(rest);
  return text;
}

}  // namespace

std::string number(double value) {
  std::string text = fmt::format("{:.2f}", value);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      case '\'': result += "&#39;"; break;
      default: result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;  // XML cannot represent the others
    }
  }
  return result;
}

std::string path_data(const Points& points) {
  std::string text;
  long x = 0;
  long y = 0;
  for (const Eigen::Vector2d& point : points) {
    const bool first = text.empty();
    const long dx = tenths(point.x()) - x;
    const long dy = tenths(point.y()) - y;
    if (!first && dx == 0 && dy == 0) continue;
    x += dx;
    y += dy;
    // Coordinates are relative to the last point. In `m`, the pairs after the first one are lines.
    const std::string dx_text = tenths_text(dx);
    const std::string dy_text = tenths_text(dy);
    if (first)
      text += 'm';
    else if (dx >= 0)
      text += ' ';
    text += dx_text;
    if (dy >= 0) text += ' ';
    text += dy_text;
  }
  return text;
}

std::string polygon_points(const Points& points) {
  std::string text;
  for (const Eigen::Vector2d& point : points)
    text += fmt::format("{}{},{}", text.empty() ? "" : " ", number(point.x()), number(point.y()));
  return text;
}

Points simplified(const Points& points, double tolerance) {
  if (points.size() < 3) return points;
  std::vector<char> kept(points.size(), 0);
  kept.front() = kept.back() = 1;
  std::vector<std::pair<std::size_t, std::size_t>> spans = {{0, points.size() - 1}};
  while (!spans.empty()) {
    const auto [first, last] = spans.back();
    spans.pop_back();
    double farthest = tolerance;
    std::size_t split = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = distance_to_segment(points[i], points[first], points[last]);
      if (distance > farthest) {
        farthest = distance;
        split = i;
      }
    }
    if (split == first) continue;
    kept[split] = 1;
    spans.emplace_back(first, split);
    spans.emplace_back(split, last);
  }
  Points result;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (kept[i]) result.push_back(points[i]);
  return result;
}

std::string oklch(double lightness, double chroma, double hue) {
  constexpr double chroma_step = 0.002;
  std::optional<std::array<double, 3>> colour;
  while (!(colour = srgb(lightness, chroma, hue)) && chroma > 0.0) chroma = std::max(0.0, chroma - chroma_step);
  std::string text = "#";
  for (const double channel : colour.value_or(std::array<double, 3>{}))
    text += fmt::format("{:02x}", static_cast<unsigned>(std::lround(255.0 * channel)));
  return text;
}

std::string colour_of(std::size_t index, std::size_t count, double shade) {
  return oklch((index % 2 == 0 ? 0.67 : 0.55) + shade, 0.15, static_cast<double>(index) / static_cast<double>(count));
}

}  // namespace cohort::tool::svg
