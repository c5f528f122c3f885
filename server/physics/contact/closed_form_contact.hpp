#pragma once

#include "server/physics/contact/contact_point.hpp"

namespace cohort::physics {

/// Finds where two shapes come nearer than `margin` [m], if there is a closed form for them: anything round or angular
/// on a plane, spheres and capsules against each other and against boxes and cylinders, and upright cylinders beside
/// upright cylinders and boxes. False if there is none; `found` is then unchanged. Without memory: the same poses give
/// the same points.
bool find_closed_form_contact(const geometry::Shape& a, const Pose& X_WA, const geometry::Shape& b, const Pose& X_WB,
                              double margin, ContactPoints& found);

}  // namespace cohort::physics
