#pragma once

#include <limits>

namespace cohort {

/// No bound, nothing met, or for ever.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace cohort
