// SPDX-License-Identifier: Apache-2.0
#include "tools/view/film/camera_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/yaml/yaml_map.hpp"

namespace cohort::film {
namespace {

using Components = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t most_bytes = std::size_t{1} << 20;

// Returns the slope between two secants: their weighted harmonic mean, or 0 at an extremum.
double slope_between(double before, double after, double length_before, double length_after) {
  if (before * after <= 0.0) return 0.0;
  const double w1 = 2.0 * length_after + length_before;
  const double w2 = length_after + 2.0 * length_before;
  return (w1 + w2) / (w1 / before + w2 / after);
}

std::vector<Components> slopes_of(const std::vector<double>& times, const std::vector<Components>& values) {
  std::vector<Components> slopes(values.size(), Components::Zero());  // the camera starts and ends at rest
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    const double before = times[i] - times[i - 1];
    const double after = times[i + 1] - times[i];
    for (Eigen::Index k = 0; k < slopes[i].size(); ++k)
      slopes[i][k] = slope_between((values[i][k] - values[i - 1][k]) / before,
                                   (values[i + 1][k] - values[i][k]) / after, before, after);
  }
  return slopes;
}

std::optional<Eigen::Vector3d> read_point(const parsing::YamlMap& map, const std::string& key) {
  map.require(key, "a point [x, y, z] in metres");
  if (!map.has(key)) return std::nullopt;
  const parsing::YamlNode& node = map.where(key);
  Eigen::Vector3d point;
  if (node.is_list() && node.items.size() == 3) {
    bool is_valid = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const parsing::YamlNode& item = *node.items[i];
      const std::optional<double> number = item.is_scalar() ? parse_real(item.text) : std::nullopt;
      is_valid = is_valid && number && std::abs(*number) <= 1e6;
      if (is_valid) point[static_cast<Eigen::Index>(i)] = *number;
    }
    if (is_valid) return point;
  }
  map.problem(key, "expected a point [x, y, z] in metres");
  return std::nullopt;
}

std::vector<CameraPath::Point> read_points(const parsing::YamlNode& list, const parsing::YamlReport& report) {
  std::vector<CameraPath::Point> points;
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    const std::string path = fmt::format("path[{}]", i);
    const parsing::YamlMap map(*list.items[i], path, {"time", "position", "target"}, report);
    if (!list.items[i]->is_map()) continue;
    map.require("time", "a time in the recording, in seconds");
    const std::optional<double> time = map.real("time");
    const std::optional<Eigen::Vector3d> position = read_point(map, "position");
    const std::optional<Eigen::Vector3d> target = read_point(map, "target");
    if (!time || !position || !target) continue;
    if (!points.empty() && *time <= points.back().time)
      map.problem("time", fmt::format("expected a time after {:g}, the one before it", points.back().time));
    if (position->isApprox(*target)) map.problem("target", "expected another point than the position");
    points.push_back({*time, {*position, *target}});
  }
  return points;
}

}  // namespace

CameraPath::CameraPath(const std::vector<Point>& points, std::optional<std::string> follow)
    : follow_(std::move(follow)) {
  for (const Point& point : points) {
    times_.push_back(point.time);
    values_.emplace_back();
    values_.back() << point.viewpoint.position, point.viewpoint.target;
  }
  slopes_ = slopes_of(times_, values_);
}

Viewpoint CameraPath::at(double time) const {
  const auto after = std::ranges::upper_bound(times_, time);
  Components value;
  if (after == times_.begin()) {
    value = values_.front();
  } else if (after == times_.end()) {
    value = values_.back();
  } else {
    const auto i = static_cast<std::size_t>(after - times_.begin()) - 1;
    const double length = times_[i + 1] - times_[i];
    const double s = (time - times_[i]) / length;
    // The cubic Hermite basis.
    const double h00 = (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s);
    const double h10 = s * (1.0 - s) * (1.0 - s);
    const double h11 = s * s * (s - 1.0);
    value = h00 * values_[i] + (1.0 - h00) * values_[i + 1] + length * (h10 * slopes_[i] + h11 * slopes_[i + 1]);
  }
  return {value.head<3>(), value.tail<3>()};
}

CameraPath parse_camera_path(std::string_view text, const std::filesystem::path& file) {
  const parsing::YamlDocument document = parsing::parse_yaml(text);
  if (document.error)
    throw description::InputError({{file, document.error->line, "", "not YAML: " + document.error->message}});
  std::vector<description::Problem> problems;
  const parsing::YamlReport report(file, problems);
  const parsing::YamlMap map(*document.root, "", {"follow", "path"}, report);
  std::vector<CameraPath::Point> points;
  std::optional<std::string> follow = map.text("follow");
  if (document.root->is_map()) {
    map.require("path", "a list of {time, position, target}");
    const parsing::YamlNode& list = map.where("path");
    if (map.has("path") && (!list.is_list() || list.items.empty() || list.items.size() > CameraPath::most_viewpoints))
      map.problem("path", fmt::format("expected a list of 1 to {} points {{time, position, target}}",
                                      CameraPath::most_viewpoints));
    else if (map.has("path"))
      points = read_points(list, report);
  }
  if (!problems.empty()) throw description::InputError(std::move(problems));
  return CameraPath(points, std::move(follow));
}

CameraPath read_camera_path(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(most_bytes + 1, '\0');
  if (in) in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!in.is_open() || in.bad())
    throw std::runtime_error(file.string() + " cannot be read: " + std::generic_category().message(errno));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > most_bytes) throw std::runtime_error(file.string() + ": a camera path has at most 1 MiB");
  return parse_camera_path(text, file);
}

}  // namespace cohort::film
