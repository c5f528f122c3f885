#include "server/physics/ground.hpp"

#include <algorithm>

namespace cohort::physics {

GroundFinder::GroundFinder(const geometry::Scene& scene, std::uint32_t body, const Eigen::Vector3d& centre_W,
                           double radius, const Eigen::Vector3d& up_W, double climb, double reach)
    : scene_(scene), up_W_(up_W), climb_(climb), reach_(reach) {
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(radius + std::max(climb, reach));
  near_ = scene.solids_in({centre_W - half, centre_W + half}, body);
}

std::optional<Ground> GroundFinder::below(const Eigen::Vector3d& point_W) const {
  const auto hit = scene_.cast_ray_among(near_, point_W + climb_ * up_W_, -up_W_, climb_ + reach_);
  if (!hit || hit->distance == 0.0) return std::nullopt;
  const geometry::Solid& solid = scene_.solid(hit->solid);
  if (solid.moves) return std::nullopt;
  return Ground{(hit->distance - climb_) * up_W_.dot(hit->normal_W), hit->normal_W, solid.surface.friction};
}

}  // namespace cohort::physics
