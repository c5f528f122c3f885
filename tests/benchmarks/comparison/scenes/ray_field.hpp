// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "server/geometry/scene/scene.hpp"

namespace cohort::bench {

/// Turrets at random positions in the cells of a square grid, without contacts, with 24 rays of 20 cm each.
class RayField {
 public:
  RayField(std::uint32_t robots, double spacing, std::uint64_t seed);

  /// Sets every pose and updates the grid, as after a step.
  void move_all();
  /// Casts rays from the rim of each robot against all others, as a proximity ring does. Returns the number of hits.
  std::size_t cast() const;

  double rays() const;

 private:
  geometry::Scene scene_;
  std::vector<Pose> poses_;
  std::vector<Eigen::Vector3d> directions_;
};

}  // namespace cohort::bench
