#pragma once

#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Adds a warning for each name of an element or attribute whose effect on motion or measurements is missing here, and
/// one for the whole file that names what only affects other simulators (`Effect` in the rules). What only affects
/// appearance, or has SDF's standard value, is passed over. For the newest version of SDFormat.
void tell_of_missing_effects(const XmlNode& tree, std::vector<Problem>& warnings);

}  // namespace cohort::parsing
