#pragma once

#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Takes out of a file of SDFormat's newest version the elements and attributes that SDFormat does not know, as other
/// readers pass over them. What has a prefix, and what stands where anything may, stays.
void pass_over_unknown(XmlNode& tree, std::vector<Problem>& warnings);

}  // namespace cohort::parsing
