#pragma once

#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/urdf/urdf_notes.hpp"

namespace cohort::parsing {

/// Renames joints that have the name of a link, which SDF does not allow.
void name_joints_apart(XmlNode& robot, UrdfNotes& notes);

/// Gives a joint a known type and limits; missing limits mean no limits.
void mend_joint(XmlNode& joint, UrdfNotes& notes);

/// Removes a root without mass whose only joint is a floating one, so that its child is the root.
void omit_empty_root(XmlNode& robot);

/// Removes <mimic> that names a missing joint.
void omit_lost_mimics(XmlNode& robot, UrdfNotes& notes);

}  // namespace cohort::parsing
