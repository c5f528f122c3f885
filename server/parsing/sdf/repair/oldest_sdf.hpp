// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// The first version that writes most values as elements.
inline constexpr std::string_view first_with_elements = "1.2";

/// Converts a tree of SDF 1.0 to that of SDF 1.2, in which most values are elements instead of attributes. Returns
/// whether there was such an attribute: many newer files have a wrong version.
bool make_attributes_elements(XmlNode& sdf);

}  // namespace cohort::parsing
