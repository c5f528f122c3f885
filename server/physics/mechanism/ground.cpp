// SPDX-License-Identifier: Apache-2.0
#include "server/physics/mechanism/ground.hpp"

namespace cohort::physics {
namespace {

// Cosine of the slope angle; a steeper surface is a wall, not ground.
constexpr double steepest = 0.3;

}  // namespace

std::optional<Ground> GroundFinder::below(const Eigen::Vector3d& point_W) const {
  const auto hit = scene_.cast_ray_among(candidates_, point_W + climb_ * up_W_, -up_W_, climb_ + reach_);
  if (!hit || hit->distance == 0.0) return std::nullopt;
  const double faces_up = up_W_.dot(hit->normal_W);
  if (faces_up < steepest) return std::nullopt;
  return Ground{hit->solid, (hit->distance - climb_) * faces_up, hit->normal_W};
}

}  // namespace cohort::physics
