#pragma once

#include "server/description/event.hpp"
#include "server/parsing/experiment/schedule_entry.hpp"

namespace cohort::parsing {

/// What is written, in place of what `recorded` has. What is wrong is reported.
void read_recorded(const ScheduleEntry& entry, const World& world, Recorded& recorded);

}  // namespace cohort::parsing
