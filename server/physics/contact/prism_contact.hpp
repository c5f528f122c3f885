#pragma once

#include "server/physics/contact/contact_point.hpp"

namespace cohort::physics {

/// The contact of a cylinder beside another, or beside a box, with their axes almost parallel: of robots and walls that
/// stand upright. Where both overlap along the axis, the two are a circle and another, or a rectangle; the normal is
/// square to the axis, and the ends of the common stretch are the points. Bullet's general algorithm gives one point
/// with a normal that tilts as soon as a robot does. False, and nothing found, where the ends of the shapes matter.
bool find_side_contact(const description::Cylinder& a, const Pose& X_WA, const description::Cylinder& b,
                       const Pose& X_WB, double margin, ContactPoints& found);
bool find_side_contact(const description::Cylinder& a, const Pose& X_WA, const description::Box& b, const Pose& X_WB,
                       double margin, ContactPoints& found);

}  // namespace cohort::physics
