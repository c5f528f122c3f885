#pragma once

#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/urdf/urdf_notes.hpp"
#include "server/parsing/sdf/urdf/urdf_rest.hpp"

namespace cohort::parsing {

/// Gives joints that have the name of a link another one: in SDF, the two are not of one name.
void name_joints_apart(XmlNode& robot, UrdfNotes& notes);

/// Makes a joint of a type that the format allows, with limits: those that are missing are none.
void mend_joint(XmlNode& joint, UrdfRest& rest, UrdfNotes& notes);

/// Lets the child of each floating joint go. Of a root without mass nothing is left, otherwise there are two bodies
/// that are free.
void let_go(XmlNode& robot, UrdfRest& rest);

}  // namespace cohort::parsing
