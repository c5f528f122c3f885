#pragma once

#include <optional>
#include <string>

#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/urdf/urdf_notes.hpp"

namespace cohort::parsing {

/// Returns <surface> of SDF for <contact> of Bullet: friction, restitution and stiffness of the surface of a link.
/// Returns nothing if the element has no known content.
std::optional<XmlNode> surface_of(const XmlNode& contact, const std::string& path, UrdfNotes& notes);

}  // namespace cohort::parsing
