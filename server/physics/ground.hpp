#pragma once

#include <optional>
#include <vector>

#include "server/geometry/scene.hpp"

namespace cohort::physics {

/// What a point of a track stands on, or is about to.
struct Ground {
  std::uint32_t solid = 0;
  double gap = 0.0;  ///< from the surface to the point along the normal [m], negative: the point is below the surface
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();
  double friction = 0.0;
};

/// Finds the ground under points of one body, for as long as nothing moves. Any shape that a ray can hit can be ground,
/// whether it moves or not.
class GroundFinder {
 public:
  /// All points lie within `radius` of `centre_W`. The ground is looked for along `-up_W`, from `climb` above a point
  /// to `reach` below it: a surface higher than `climb` is a wall. `near` is scratch memory.
  GroundFinder(const geometry::Scene& scene, std::uint32_t body, const Eigen::Vector3d& centre_W, double radius,
               const Eigen::Vector3d& up_W, double climb, double reach, std::vector<std::uint32_t>& near);

  /// The first solid of any other body.
  std::optional<Ground> below(const Eigen::Vector3d& point_W) const;

 private:
  const geometry::Scene& scene_;
  Eigen::Vector3d up_W_;
  double climb_;
  double reach_;
  const std::vector<std::uint32_t>& near_;
};

}  // namespace cohort::physics
