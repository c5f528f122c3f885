#pragma once

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Converts an <sdf> element of an older version to that of libsdformat, by the rules of libsdformat.
void convert_older(XmlNode& sdf);

}  // namespace cohort::parsing
