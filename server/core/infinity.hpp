// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace cohort {

/// Infinity: no bound, no hit, or no end.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace cohort
