#pragma once

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "server/description/event.hpp"
#include "server/parsing/experiment/schedule_entry.hpp"

namespace cohort::parsing {

/// What an event of this kind does to each of some objects, in their order. What cannot be done to one is reported, and
/// left out.
std::vector<std::pair<std::size_t, Effect>> read_effects(std::string_view kind, const ScheduleEntry& entry,
                                                         const World& world, const std::vector<std::size_t>& objects);

}  // namespace cohort::parsing
