#include "server/physics/ground.hpp"

#include <algorithm>

namespace cohort::physics {
namespace {

// Cosine of the angle from which on a surface is a wall, not ground.
constexpr double steepest = 0.3;

}  // namespace

GroundFinder::GroundFinder(const geometry::Scene& scene, std::uint32_t body, const Eigen::Vector3d& centre_W,
                           double radius, const Eigen::Vector3d& up_W, double climb, double reach,
                           std::vector<std::uint32_t>& near)
    : scene_(scene), up_W_(up_W), climb_(climb), reach_(reach), near_(near) {
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(radius + std::max(climb, reach));
  near.clear();
  scene.for_each_overlap({centre_W - half, centre_W + half}, [&](std::uint32_t solid) {
    if (scene.solid(solid).body != body) near.push_back(solid);
  });
}

std::optional<Ground> GroundFinder::below(const Eigen::Vector3d& point_W) const {
  const auto hit = scene_.cast_ray_among(near_, point_W + climb_ * up_W_, -up_W_, climb_ + reach_);
  if (!hit || hit->distance == 0.0) return std::nullopt;
  const double faces_up = up_W_.dot(hit->normal_W);
  if (faces_up < steepest) return std::nullopt;
  return Ground{hit->solid, (hit->distance - climb_) * faces_up, hit->normal_W,
                scene_.solid(hit->solid).surface.friction};
}

}  // namespace cohort::physics
