#pragma once

#include <cstdint>

#include "server/description/experiment.hpp"
#include "server/placement/placer.hpp"

namespace cohort::placement {

/// Returns the experiment with another seed: as it is when it is read with this seed, but for what has been set since
/// it was read. Throws InputError, with the problems that reading has, if a population has less room than it needs, or
/// if what the experiment names is not there. Nothing is parsed, opened or locked; callable from any thread.
Experiment with_seed(const Experiment& experiment, std::uint64_t seed);

/// The same with a placer that was made of the experiment's world, for those who need many seeds.
Experiment with_seed(const Experiment& experiment, const Placer& placer, std::uint64_t seed);

}  // namespace cohort::placement
