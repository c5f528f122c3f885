// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

/// Warns of sensors and plugins below `element` that are not simulated here, and of surface elements that have no
/// effect because another element is present or missing. Models are skipped, since each is checked separately.
void warn_of_unsupported(const Element* element, const SdfReport& report);

}  // namespace cohort::parsing
