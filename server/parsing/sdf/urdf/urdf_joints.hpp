#pragma once

#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/urdf/urdf_notes.hpp"
#include "server/parsing/sdf/urdf/urdf_rest.hpp"

namespace cohort::parsing {

/// Renames joints that have the name of a link, which SDF does not allow.
void name_joints_apart(XmlNode& robot, UrdfNotes& notes);

/// Gives a joint a valid type and limits; missing limits mean no limits.
void mend_joint(XmlNode& joint, UrdfRest& rest, UrdfNotes& notes);

/// Removes floating joints, which makes their children free bodies. A root without mass is removed too.
void let_go(XmlNode& robot, UrdfRest& rest);

}  // namespace cohort::parsing
