// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "server/description/event.hpp"
#include "server/parsing/experiment/schedule_entry.hpp"

namespace cohort::parsing {

/// Reads the effects of an event of the kind `kind` on each of `objects`. Returns pairs of an object and its effect, in
/// the order of the objects. Reports and omits impossible effects.
std::vector<std::pair<std::size_t, Effect>> read_effects(std::string_view kind, const ScheduleEntry& entry,
                                                         const World& world, const std::vector<std::size_t>& objects);

}  // namespace cohort::parsing
