// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/benchmarks/comparison/measuring/measure.hpp"

namespace cohort::bench {

struct RayCost {
  std::string density;
  double spacing = 0.0;  ///< distance of neighbouring robots [m]
  double hits = 0.0;     ///< fraction of rays that hit
  Spread rays_a_second;
};

struct RayResult {
  std::string scene;
  std::uint32_t robots = 0;
  std::vector<RayCost> costs;
};

/// Casts 24 rays of 20 cm from the rim of each robot against all others, and rebuilds the grid of moving objects each
/// time.
RayResult measure_rays(const std::string& name, std::uint32_t robots, const Options& options,
                       const Surroundings& surroundings);

}  // namespace cohort::bench
