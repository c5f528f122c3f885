// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Removes visual elements that are not shown or cannot be read, so that they never prevent reading a file from another
/// source. For the newest version of SDFormat.
void keep_what_is_shown(XmlNode& tree);

}  // namespace cohort::parsing
