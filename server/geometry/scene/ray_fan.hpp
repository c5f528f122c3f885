// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/geometry/scene/scene.hpp"

namespace cohort::geometry {

/// Several rays that start near one point, such as those of a ring of sensors. The solids that they may hit are
/// searched once, and each ray tests the nearest first. Valid as long as nothing moves.
class RayFan {
 public:
  /// Prepares for rays that stay inside `region` and start near `centre_W`: the nearer, the faster. Solids of
  /// `ignored_body` are ignored.
  RayFan(const Scene& scene, const Eigen::Vector3d& centre_W, const Bounds& region,
         BodyId ignored_body = Scene::no_body);

  /// Returns the same as `Scene::cast_ray`, bit for bit.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double range) const;

 private:
  struct Candidate {
    double distance = 0.0;  // least distance of its points from the centre [m]
    Scene::Ball ball;
    std::uint32_t solid = 0;
  };

  const Scene& scene_;
  Eigen::Vector3d centre_W_;
  std::vector<Candidate> candidates_;  // nearest first
};

}  // namespace cohort::geometry
