// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/physics/contact/contact_point.hpp"

namespace cohort::physics {

/// Finds the contact of a cylinder beside another cylinder or a box, with their axes almost parallel: robots and walls
/// that stand upright. Where both overlap along the axis, the cross-section is two circles, or a circle and a
/// rectangle. The normal is perpendicular to the axis, and the ends of the common interval are the points. Bullet's
/// general algorithm gives one point, with a normal that tilts as soon as a robot does. Returns false and finds nothing
/// where the ends of the shapes matter.
bool find_side_contact(const description::Cylinder& a, const Pose& X_WA, const description::Cylinder& b,
                       const Pose& X_WB, double margin, ContactPoints& found);
bool find_side_contact(const description::Cylinder& a, const Pose& X_WA, const description::Box& b, const Pose& X_WB,
                       double margin, ContactPoints& found);

}  // namespace cohort::physics
