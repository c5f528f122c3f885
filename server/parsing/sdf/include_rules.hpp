#pragma once

#include <optional>
#include <string>
#include <utility>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Returns the element of an <include> that cannot be, and what is wrong with it; nothing if all is right.
std::optional<std::pair<const XmlNode*, std::string>> flaw_of_include(const XmlNode& include);

/// Returns whether its model becomes a part of the model that includes it.
bool is_merged(const XmlNode& include);

}  // namespace cohort::parsing
