// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/event.hpp"
#include "server/parsing/experiment/schedule_entry.hpp"

namespace cohort::parsing {

/// Reads the given keys into `recorded`; reports problems.
void read_recorded(const ScheduleEntry& entry, const World& world, Recorded& recorded);

}  // namespace cohort::parsing
