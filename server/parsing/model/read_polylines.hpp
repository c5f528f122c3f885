// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "server/description/shape.hpp"
#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

/// A mistake in a polyline.
struct PolylineFlaw : std::runtime_error {
  PolylineFlaw(const Element* where, const std::string& message) : std::runtime_error(message), element(where) {}
  const Element* element;
};

/// Returns the extruded <polyline>s of a <geometry> as one mesh, or as their convex hull. Polylines inside of others,
/// which are holes in Gazebo, are left out, with a warning if there is a report. Returns nothing if a number is NaN,
/// which is reported elsewhere. Throws PolylineFlaw if a polyline has no volume, crosses itself or crosses another one.
std::optional<TriangleMesh> read_polylines(const Element& geometry, bool convex, const SdfReport* report);

}  // namespace cohort::parsing
