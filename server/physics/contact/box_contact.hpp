// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/physics/contact/contact_point.hpp"

namespace cohort::physics {

/// Finds the contact points of two boxes that are nearer than `margin` [m], by the separating-axis test of Gottschalk
/// et al. ("OBBTree", SIGGRAPH 1996). Candidates are the face normals and the cross products of edges; the axis with
/// the greatest separation or least overlap is used. The result is either one face clipped to the other and reduced to
/// four points, or the crossing of two edges. The axis along `last_normal_W`, the normal at the last step or zero, is
/// preferred, so that boxes at rest keep their points.
void find_box_contact(const description::Box& a, const Pose& X_WA, const description::Box& b, const Pose& X_WB,
                      double margin, const Eigen::Vector3d& last_normal_W, ContactPoints& found);

}  // namespace cohort::physics
