// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/scene/ray_fan.hpp"

#include <algorithm>

namespace cohort::geometry {

RayFan::RayFan(const Scene& scene, const Eigen::Vector3d& centre_W, const Bounds& region, BodyId ignored_body)
    : scene_(scene), centre_W_(centre_W) {
  scene.for_each_overlap(region, [&](std::uint32_t solid) {
    if (scene.solid(solid).body == ignored_body) return;
    const Scene::Ball ball = scene.ball(solid);
    candidates_.push_back({(ball.centre_W - centre_W).norm() - ball.radius, ball, solid});
  });
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
}

std::optional<RayHit> RayFan::cast(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W,
                                   double range) const {
  constexpr double rounding = 1e-9;
  const double start = (origin_W - centre_W_).norm() + rounding;
  std::optional<RayHit> best;
  double reach = range;
  for (const Candidate& candidate : candidates_) {
    if (candidate.distance > start + reach) break;
    if (!candidate.ball.is_missed(origin_W, direction_W, reach))
      reach = scene_.improve(best, candidate.solid, origin_W, direction_W, range);
  }
  return best;
}

}  // namespace cohort::geometry
