// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/physics/contact/contact_point.hpp"

namespace cohort::physics {

/// Finds the contact points of two shapes that are nearer than `margin` [m], if there is a closed form for the pair.
/// Closed forms exist for round and angular shapes on a plane and for spheres and capsules against each other, boxes
/// and cylinders. They also exist for upright cylinders beside upright cylinders and boxes. Returns false if there is
/// none; `found` is then unchanged. `last_normal_W`: the normal at the last step, or zero. The same poses and normal
/// give the same points.
bool find_closed_form_contact(const geometry::Shape& a, const Pose& X_WA, const geometry::Shape& b, const Pose& X_WB,
                              double margin, const Eigen::Vector3d& last_normal_W, ContactPoints& found);

}  // namespace cohort::physics
