// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "server/description/experiment.hpp"
#include "server/parsing/experiment/schedule_entry.hpp"

namespace cohort::parsing {

/// Reads an event `spawn`, and adds a spawner to `experiment`, whose world and teams have been read. Returns its
/// events, one for each time at which an object is created. `at`: its time, if valid; `is_reaction`: it has `on`
/// instead of a time.
std::vector<Event> read_spawn_events(const ScheduleEntry& entry, std::optional<std::chrono::nanoseconds> at,
                                     bool is_reaction, Experiment& experiment);

}  // namespace cohort::parsing
