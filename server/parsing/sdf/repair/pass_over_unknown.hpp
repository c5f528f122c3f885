// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Removes unknown elements and attributes from a file of the newest version of SDFormat, which other programs ignore
/// too. Elements with a prefix, and those in elements with free content, stay.
void pass_over_unknown(XmlNode& tree, std::vector<Problem>& warnings);

}  // namespace cohort::parsing
