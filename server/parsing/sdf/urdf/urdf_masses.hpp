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

/// Returns whether a link has mass. An unreadable one counts, so that it is reported.
bool has_mass(const XmlNode& link);

/// Changes a URDF so that its converter keeps every joint. The converter merges links that fixed joints connect. It
/// omits a link without mass, with its joint and everything below. Here such a link gets a mass: the root is fixed to
/// the world, and any other link has a mass only for the converter (`rest.weightless`). Joints on a flange without mass
/// are attached to the link that carries the flange.
void keep_links_without_mass(XmlNode& robot, const std::filesystem::path& file, UrdfRest& rest,
                             std::vector<Problem>& warnings);

}  // namespace cohort::parsing
