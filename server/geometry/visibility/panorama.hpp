// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "server/geometry/visibility/outlines.hpp"

namespace cohort::geometry {

/// An omnidirectional camera: rays in all directions from one point, in columns of equal bearing and rows of equal
/// elevation. Each solid is tested only for the pixels that it may cover, near solids first, so that those behind are
/// skipped.
class Panorama {
 public:
  /// `columns` >= 4, the first along x of the camera's frame S, the others counter-clockwise about z at equal angles.
  /// `elevations`: of the rows above the xy plane of S [rad], ascending or descending, each within +-pi/2. Throws
  /// std::invalid_argument for other values.
  Panorama(std::size_t columns, std::vector<double> elevations);

  std::size_t columns() const { return bearings_S_.size(); }
  std::size_t rows() const { return elevations_.size(); }
  /// Returns the index of a pixel; pixels are stored row by row.
  std::size_t pixel(std::size_t column, std::size_t row) const { return row * columns() + column; }
  /// Returns the unit vector of a pixel in the frame S.
  const Eigen::Vector3d& direction(std::size_t pixel) const { return directions_S_[pixel]; }

  /// Writes the hit of each pixel from X_WS within `range` [m], which may be infinite; nothing for those that see no
  /// solid. Solids of `ignored_body` are ignored. `pixels` has columns() * rows() elements.
  ///
  /// The result is the same, bit for bit, as that of Scene::cast_ray along X_WS.orientation * direction(pixel) with
  /// this range. Const, callable from any thread.
  void cast(const Outlines& outlines, const Pose& X_WS, double range, BodyId ignored_body,
            std::span<std::optional<RayHit>> pixels) const;

 private:
  struct Window;
  struct View;

  std::optional<Window> window_of(const Scene& scene, std::uint32_t solid, const View& view) const;
  std::pair<std::size_t, std::size_t> rows_between(double least, double most) const;

  std::vector<Eigen::Vector2d> bearings_S_;  // by column
  std::vector<double> elevations_;           // by row [rad]
  std::vector<Eigen::Vector3d> directions_S_;
  bool ascending_ = true;
};

}  // namespace cohort::geometry
