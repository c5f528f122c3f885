// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort::geometry {

/// Returns an upper bound on the rounding error of lengths of this size [m].
inline double rounding_of(double length) { return 1e-7 + 1e-8 * length; }

}  // namespace cohort::geometry
