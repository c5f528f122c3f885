// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tests/benchmarks/comparison/lockstep/lockstep_rows.hpp"

namespace cohort::bench {

/// Measures the benefit of `delay: 1`. Physics (one thread) and a controller process compute for the same time in each
/// tick: one after the other without a delay, at the same time with it. Throws like `measure_lockstep`.
std::vector<LookAheadRow> measure_look_ahead(const LockstepOptions& options, const Surroundings& surroundings);

}  // namespace cohort::bench
