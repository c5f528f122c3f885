// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "server/description/world.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Returns a world as SDF 1.9: every instance that is present initially, in its order, as a separate complete model.
/// Reading it gives identical values: rotations are quaternions, numbers have enough digits, and meshes and height maps
/// are their original files, named relative to `folder`. Models get the names of the instances; comments, visuals and
/// frames are not kept.
XmlNode sdf_of(const World& world, const std::filesystem::path& folder);

/// Returns the text of an XML file.
std::string xml_text(const XmlNode& root);

}  // namespace cohort::parsing
