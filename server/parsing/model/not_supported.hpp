#pragma once

#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

/// Warns of sensors and plugins below `element` that are not simulated here, and of elements of surfaces that have no
/// effect beside or without another one. Models are skipped, since each is checked separately.
void warn_of_unsupported(const Element* element, const SdfReport& report);

}  // namespace cohort::parsing
