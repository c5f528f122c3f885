#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "server/description/experiment.hpp"
#include "server/parsing/experiment/schedule_entry.hpp"

namespace cohort::parsing {

/// Reads what an event `spawn` says, and adds a spawner to `experiment`, whose world and teams are read. Returns the
/// events that it stands for, one for each time at which something comes. `at`: its time, if it has one that is right;
/// `is_reaction`: it has `on` in place of a time.
std::vector<Event> read_spawn_events(const ScheduleEntry& entry, std::optional<std::chrono::nanoseconds> at,
                                     bool is_reaction, Experiment& experiment);

}  // namespace cohort::parsing
