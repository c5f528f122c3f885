#pragma once

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Leaves of what is only seen what is shown here, and takes out what cannot be read, so that it never stops a file
/// that was not written for Cohort. Of SDFormat's newest version.
void keep_what_is_shown(XmlNode& tree);

}  // namespace cohort::parsing
