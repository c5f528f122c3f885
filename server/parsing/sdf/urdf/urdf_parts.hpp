// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/urdf/urdf_tree.hpp"

/// Parts of a link in SDF, made from a link in URDF and those that are merged with it.
namespace cohort::parsing {

/// Returns whether a link, or any link that is merged with it, has mass.
bool has_mass(const UrdfLink& link);

bool has_plane(const UrdfLink& link);

/// Returns <inertial> with the sum of the masses. A link without mass has a mass of 0, which is later computed from its
/// shapes, unless it is fixed to the world.
XmlNode inertial_of(const UrdfLink& link);

/// Returns <collision> or <visual> of a link, without properties of its surface. `index` is its number among those of
/// the carrier.
XmlNode part_of(const UrdfLink& link, const XmlNode& source, std::size_t index);

/// Changes the name of the collision in a contact sensor of a link to that in the element of its carrier.
void adjust_contact(const UrdfLink& link, const XmlNode& carrier, XmlNode& sensor);

/// Returns whether <gazebo> blocks of the link apply to a collision or visual of its carrier. As in Gazebo, its name
/// decides.
bool belongs_to(const UrdfLink& link, const XmlNode& part);

/// Adds the surface of a link to one of its collisions, except properties that the collision has already.
void add_surface(const UrdfLink& link, XmlNode& collision);

/// Adds the colour of a visual, unless its material has colours already.
void add_material(const XmlNode& robot, const XmlNode& source, XmlNode& visual);

}  // namespace cohort::parsing
