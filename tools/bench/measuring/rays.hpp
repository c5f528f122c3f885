#pragma once

#include "tools/bench/measuring/measure.hpp"

namespace cohort::bench {

struct RayCost {
  std::string density;
  double spacing = 0.0;  ///< of the robots [m]
  double hits = 0.0;     ///< share of the rays
  Spread rays_a_second;
};

struct RayResult {
  std::string scene;
  std::uint32_t robots = 0;
  std::vector<RayCost> costs;
};

/// 24 rays of 20 cm from the rim of each robot against all others, with the grid of moving things built anew each time.
RayResult measure_rays(const std::string& name, std::uint32_t robots, const Options& options,
                       const Surroundings& surroundings);

}  // namespace cohort::bench
