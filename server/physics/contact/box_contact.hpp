#pragma once

#include "server/physics/contact/contact_point.hpp"

namespace cohort::physics {

/// Where two boxes come nearer than `margin` [m]: the axis along which they are furthest apart or overlap least among
/// the directions of faces and pairs of edges, then either the part of one face over the other, thinned out to four
/// points, or the crossing of two edges (the separating-axis test of Gottschalk et al., "OBBTree", SIGGRAPH 1996).
void find_box_contact(const description::Box& a, const Pose& X_WA, const description::Box& b, const Pose& X_WB,
                      double margin, ContactPoints& found);

}  // namespace cohort::physics
