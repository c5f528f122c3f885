// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cohort::film {

/// A viewpoint in the world frame, or relative to the followed objects, with the axes of the world frame [m].
struct Viewpoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
};

/// A camera that moves smoothly through viewpoints.
class CameraPath {
 public:
  static constexpr std::size_t most_viewpoints = 10'000;

  struct Point {
    double time = 0.0;  ///< in the recording [s]
    Viewpoint viewpoint;
  };

  /// `points` has at least one element, with ascending times.
  explicit CameraPath(const std::vector<Point>& points, std::optional<std::string> follow = {});

  /// Returns the interpolated viewpoint at a time; before the first point and after the last one, that point. Every
  /// component is a monotone piecewise cubic function of time, so it never overshoots, and the camera stays still
  /// between equal points: F. N. Fritsch and J. Butland, A method for constructing local monotone piecewise cubic
  /// interpolants, SIAM J. Sci. Stat. Comput. 5 (1984).
  Viewpoint at(double time) const;
  /// Returns the team, robot or object to which the points are relative.
  const std::optional<std::string>& follow() const { return follow_; }

 private:
  using Components = Eigen::Matrix<double, 6, 1>;
  std::vector<double> times_;
  std::vector<Components> values_;
  std::vector<Components> slopes_;
  std::optional<std::string> follow_;
};

/// Reads a file of the following form, in which `follow` is optional. Throws description::InputError, or
/// std::runtime_error if the file cannot be read.
///
///     follow: explorers
///     path:
///       - {time: 0, position: [1, -2, 1.5], target: [0, 0, 0]}
CameraPath read_camera_path(const std::filesystem::path& file);

/// Parses the text of such a file. `file` is its name in error messages.
CameraPath parse_camera_path(std::string_view text, const std::filesystem::path& file);

}  // namespace cohort::film
