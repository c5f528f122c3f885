// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/yaml/setting.hpp"

namespace cohort::parsing {

/// Sets a value in a tree of SDF. The steps of the path are elements and attributes as in a world in YAML, without the
/// prefix of Cohort. The name of an element may follow it, such as `world.model.wall.static`. Missing elements are
/// added, except those with a name. Adds problems to `problems`; the tree is then unchanged.
void set_in_sdf(XmlNode& sdf, const Setting& setting, std::vector<Problem>& problems);

}  // namespace cohort::parsing
