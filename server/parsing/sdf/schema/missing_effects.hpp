// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Adds a warning for each name of an element or attribute whose effect on motion or measurements is missing here. Adds
/// one more for the whole file, which names everything that only affects other simulators (`Effect` in the rules).
/// There is no warning about appearance, or about default values of SDF. For the newest version of SDFormat.
void tell_of_missing_effects(const XmlNode& tree, std::vector<Problem>& warnings);

}  // namespace cohort::parsing
