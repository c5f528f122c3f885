#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/description/footprint.hpp"

namespace cohort::description {

/// Where the instances of a population may be.
struct UniformPlacement {
  std::string name;  ///< of the population
  std::uint64_t seed = 1;
  std::uint64_t count = 0;
  Eigen::Vector2d lower = Eigen::Vector2d::Zero();  ///< of the instances' origins [m]
  Eigen::Vector2d upper = Eigen::Vector2d::Zero();
  double gap = 0.0;  ///< [m]
};

/// Poses, at z = 0 with any heading, for instances of a model: uniform in the rectangle, and with a gap of at least
/// `gap` between the bounding circle of an instance and every obstacle and the bounding circle of every other one. The
/// circle is about the model's origin, so the heading does not matter. An obstacle that lies entirely above the model,
/// or entirely below the ground that it stands on, is not in the way.
///
/// Rejection sampling. The draws of instance i depend on seed, name and i alone, not on how often others were rejected.
/// Fewer than `count` poses if one instance finds no place in a bounded number of tries.
std::vector<Pose> place_uniformly(const UniformPlacement& placement, const Model& model,
                                  const std::vector<Footprint>& obstacles);

}  // namespace cohort::description
