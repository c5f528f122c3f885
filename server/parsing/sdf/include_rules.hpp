// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Returns the invalid element of an <include> and its problem; nothing if all are valid.
std::optional<std::pair<const XmlNode*, std::string>> flaw_of_include(const XmlNode& include);

/// Returns whether the model becomes a part of the model that includes it.
bool is_merged(const XmlNode& include);

}  // namespace cohort::parsing
