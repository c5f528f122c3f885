#pragma once

#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

/// Warns of every element at or below `element` that would affect motion or sensing in other simulators but is not
/// simulated here. Models inside a world are skipped, since each is checked separately.
void warn_of_unsupported(const Element* element, const SdfReport& report);

}  // namespace cohort::parsing
