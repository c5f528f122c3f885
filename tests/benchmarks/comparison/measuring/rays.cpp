// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/measuring/rays.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tests/benchmarks/comparison/measuring/clocks.hpp"
#include "tests/benchmarks/comparison/scenes/ray_field.hpp"

namespace cohort::bench {
namespace {

constexpr double least_rays = 5e5;  // per repetition, so that the cost of reading the clock is negligible

}  // namespace

RayResult measure_rays(const std::string& name, std::uint32_t robots, const Options& options,
                       const Surroundings& surroundings) {
  RayResult result{name, robots, {}};
  for (const auto& [density, spacing] : {std::pair{"sparse", 0.7}, std::pair{"dense", 0.14}}) {
    surroundings.progress(fmt::format("{}, {} robots: {}", name, robots, density));
    RayField field(robots, spacing, options.seed);
    const double hits = static_cast<double>(field.cast()) / field.rays();
    const auto times = static_cast<unsigned>(std::ceil(least_rays / field.rays()));
    std::vector<double> speeds;
    for (unsigned repetition = 0; repetition < options.repetitions; ++repetition) {
      if (surroundings.stop) throw Interrupted();
      const double before = cpu_seconds();
      for (unsigned i = 0; i < times; ++i) {
        field.move_all();
        field.cast();
      }
      speeds.push_back(times * field.rays() / (cpu_seconds() - before));
    }
    result.costs.push_back({density, spacing, hits, spread_of(speeds)});
  }
  return result;
}

}  // namespace cohort::bench
