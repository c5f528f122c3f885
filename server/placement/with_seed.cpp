// SPDX-License-Identifier: Apache-2.0
#include "server/placement/with_seed.hpp"

#include <string>
#include <utility>
#include <vector>

#include "server/placement/place.hpp"

namespace cohort::placement {

Experiment with_seed(const Experiment& experiment, std::uint64_t seed) {
  return with_seed(experiment, Placer(experiment.world), seed);
}

Experiment with_seed(const Experiment& experiment, const Placer& placer, std::uint64_t seed) {
  Experiment other = experiment;
  other.seed = seed;
  std::vector<Problem> problems;
  const bool has_same_instances = place(other.world, placer, seed, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  if (has_same_instances) return other;
  if (!other.select_again)
    throw InputError(
        {{other.file, 0, "",
          "seed " + std::to_string(seed) +
              " results in different instances; only an experiment that was read from a file supports this"}});
  other.select_again(other);
  return other;
}

}  // namespace cohort::placement
