#pragma once

#include <vector>

#include "server/description/shape.hpp"

namespace cohort::geometry {

/// The convex hull of points: those of them that are its corners, in their order, and its faces as triangles. Points on
/// a face may be among the corners; one that stands out by less than 1e-11 of the extent may be left out. Equal points
/// give equal bits.
///
/// Quickhull (Barber, Dobkin, Huhdanpaa, "The quickhull algorithm for convex hulls", ACM TOMS 22(4), 1996), on
/// coordinates rounded to integers, so that every decision is exact and no set of points is too awkward.
///
/// Throws std::invalid_argument if the points span no volume. They must be finite.
description::TriangleMesh convex_hull(const std::vector<Eigen::Vector3d>& points);

}  // namespace cohort::geometry
