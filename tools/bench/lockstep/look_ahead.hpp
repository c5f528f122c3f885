#pragma once

#include <vector>

#include "tools/bench/lockstep/lockstep_rows.hpp"

namespace cohort::bench {

/// What `delay: 1` is worth: the physics (one thread) and a controller process compute for the same time in each tick.
/// Without a delay one waits for the other, with one they compute at the same time. Throws as `measure_lockstep`.
std::vector<LookAheadRow> measure_look_ahead(const LockstepOptions& options, const Surroundings& surroundings);

}  // namespace cohort::bench
