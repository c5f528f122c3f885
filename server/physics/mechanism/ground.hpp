// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "server/geometry/scene/scene.hpp"

namespace cohort::physics {

/// The ground under a point of a track, touched or about to be.
struct Ground {
  std::uint32_t solid = 0;
  double gap = 0.0;  ///< from the surface to the point along the normal [m], negative: the point is below the surface
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();
};

/// Finds the ground under points of one body. Valid as long as nothing moves. Any shape that a ray can hit can be
/// ground, moving or not.
class GroundFinder {
 public:
  /// Casts rays along `-up_W`, from `climb` above a point to `reach` below it; a surface higher than `climb` is a wall.
  /// `candidates`: the solids of other bodies that overlap the region of the rays.
  GroundFinder(const geometry::Scene& scene, std::span<const std::uint32_t> candidates, const Eigen::Vector3d& up_W,
               double climb, double reach)
      : scene_(scene), candidates_(candidates), up_W_(up_W), climb_(climb), reach_(reach) {}

  /// Returns the ground on the first candidate that the ray hits.
  std::optional<Ground> below(const Eigen::Vector3d& point_W) const;

 private:
  const geometry::Scene& scene_;
  std::span<const std::uint32_t> candidates_;
  Eigen::Vector3d up_W_;
  double climb_;
  double reach_;
};

}  // namespace cohort::physics
