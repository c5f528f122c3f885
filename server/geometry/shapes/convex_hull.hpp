// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/description/shape.hpp"

namespace cohort::geometry {

/// Returns the convex hull of points as a mesh: the points that are its corners, in their given order, and its faces as
/// triangles. The corners may include points on a face, and may omit one that protrudes by less than 1e-11 of the
/// extent. Equal points give equal bits.
///
/// Quickhull (Barber, Dobkin, Huhdanpaa, "The quickhull algorithm for convex hulls", ACM TOMS 22(4), 1996). Coordinates
/// are rounded to integers, so that every decision is exact and degenerate input is handled.
///
/// Throws std::invalid_argument if the points span no volume. They must be finite.
description::TriangleMesh convex_hull(const std::vector<Eigen::Vector3d>& points);

}  // namespace cohort::geometry
