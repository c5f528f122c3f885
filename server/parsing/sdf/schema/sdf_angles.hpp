// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Returns what is wrong with the rotation or the angle in an element of SDF, if it is out of range. Text that is not a
/// finite number is reported elsewhere.
std::optional<std::string> flaw_of_angles(const XmlNode& node);

}  // namespace cohort::parsing
