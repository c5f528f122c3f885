// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Converts an <sdf> element with a version from 1.2 to 1.8 into one with `converted_version`: replaces older spellings
/// by newer ones. In files with an older version, it only changes the version and the frames of includes.
void convert_older(XmlNode& sdf);

}  // namespace cohort::parsing
