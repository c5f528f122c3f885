#pragma once

namespace cohort::geometry {

/// More than any rounding of lengths like this one. [m]
inline double rounding_of(double length) { return 1e-7 + 1e-8 * length; }

}  // namespace cohort::geometry
