// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "server/description/experiment.hpp"
#include "server/placement/placer.hpp"

namespace cohort::placement {

/// Returns the experiment with another seed: as if it had been read with this seed, but with all settings that were
/// changed after reading. Throws InputError, with the problems that reading reports, if there is not enough room for a
/// population or if an object that the experiment names does not exist. Parses, opens and locks nothing; callable from
/// any thread.
Experiment with_seed(const Experiment& experiment, std::uint64_t seed);

/// Acts like the function above, with a placer that was made from the world of the experiment, for programs that need
/// many seeds.
Experiment with_seed(const Experiment& experiment, const Placer& placer, std::uint64_t seed);

}  // namespace cohort::placement
