// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// The element name of a joint that an <include> adds to its model. No file can contain an element of this name.
inline constexpr std::string_view added_joint = ":joint";

/// Joints between the world and one of its models, by the name of the model, as <joint> elements for that model.
using HoldingJoints = std::multimap<std::string, XmlNode>;

/// Removes the joints of a world. Those between two models become <cohort:breakable_joint>s that do not break, and
/// those to the world are returned; joints of types that are not supported are ignored with a warning. `path`: that of
/// the world.
HoldingJoints take_world_joints(XmlNode& world, const std::string& path, std::vector<Problem>& warnings);

}  // namespace cohort::parsing
