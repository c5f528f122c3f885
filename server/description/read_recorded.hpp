#pragma once

#include "server/description/course_entry.hpp"
#include "server/description/event.hpp"

namespace cohort::description {

/// What is written, in place of what `recorded` has. What is wrong is reported.
void read_recorded(const CourseEntry& entry, const World& world, Recorded& recorded);

}  // namespace cohort::description
