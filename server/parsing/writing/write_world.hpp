#pragma once

#include <filesystem>
#include <string>

#include "server/description/world.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// A world as SDF 1.9: every instance that is present at first, in its order, as a model of its own, with all that is
/// known of it. Read again it is the same bit for bit: rotations are quaternions, numbers have as many digits as that
/// takes, and meshes and height maps are the files that they came from, named relative to `folder`. Names of models
/// become those of the instances; comments, visuals and frames are not kept.
XmlNode sdf_of(const World& world, const std::filesystem::path& folder);

/// As the text of an XML file.
std::string xml_text(const XmlNode& root);

}  // namespace cohort::parsing
