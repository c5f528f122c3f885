#pragma once

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Changes an <sdf> element of an older version to libsdformat's own, by the rules that libsdformat has for that.
void convert_older(XmlNode& sdf);

}  // namespace cohort::parsing
