#include "server/physics/ground.hpp"

namespace cohort::physics {

std::optional<Ground> find_ground(const geometry::Scene& scene, std::uint32_t body, const Eigen::Vector3d& point_W,
                                  const Eigen::Vector3d& up_W, double climb, double reach) {
  const auto hit = scene.cast_ray(point_W + climb * up_W, -up_W, climb + reach, body);
  if (!hit || hit->distance == 0.0) return std::nullopt;
  const geometry::Solid& solid = scene.solid(hit->solid);
  if (solid.moves) return std::nullopt;
  return Ground{(hit->distance - climb) * up_W.dot(hit->normal_W), hit->normal_W, solid.surface.friction};
}

}  // namespace cohort::physics
