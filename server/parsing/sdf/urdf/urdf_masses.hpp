#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/urdf/urdf_rest.hpp"

namespace cohort::parsing {

/// Returns the link that <parent> or <child> of a joint names; empty if there is none.
std::string urdf_end(const XmlNode& joint, const char* end);

/// Returns whether a link has mass. What cannot be read counts: it is to be told.
bool has_mass(const XmlNode& link);

/// Changes a URDF so that its converter keeps every joint. The converter makes one link of those that fixed joints
/// connect. It leaves out a link without mass, with its joint and all that hangs on it. Here such a link gets a mass:
/// the root one that the world holds, any other one a mass for the converter alone (`rest.weightless`). A joint that
/// hangs on a flange without mass hangs on what holds the flange.
void keep_links_without_mass(XmlNode& robot, const std::filesystem::path& file, UrdfRest& rest,
                             std::vector<Problem>& warnings);

}  // namespace cohort::parsing
