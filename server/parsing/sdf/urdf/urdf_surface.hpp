#pragma once

#include <optional>
#include <string>

#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/urdf/urdf_notes.hpp"

namespace cohort::parsing {

/// Returns SDF's <surface> for Bullet's <contact>: how the surface of a link rubs, bounces and gives way. Returns
/// nothing if the element says nothing that is known.
std::optional<XmlNode> surface_of(const XmlNode& contact, const std::string& path, UrdfNotes& notes);

}  // namespace cohort::parsing
