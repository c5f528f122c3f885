#pragma once

#include <optional>

#include "server/geometry/scene.hpp"

namespace cohort::physics {

/// What a point of a track stands on, or is about to.
struct Ground {
  double gap = 0.0;  ///< from the surface to the point along the normal [m], negative: the point is below the surface
  Eigen::Vector3d normal_W;
  double friction = 0.0;
};

/// Finds the ground under a point of `body`: the first solid of any other body that does not move, looked for along
/// `-up_W` from `climb` above the point to `reach` below it. A surface higher than `climb` is a wall and not ground.
/// Any shape that can be hit by a ray can be ground.
std::optional<Ground> find_ground(const geometry::Scene& scene, std::uint32_t body, const Eigen::Vector3d& point_W,
                                  const Eigen::Vector3d& up_W, double climb, double reach);

}  // namespace cohort::physics
