// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace cohort {

/// Returns `value`, a coordinate in cells, clamped to the range of a grid; NaN gives the lower limit. Within that
/// range, a double is exact to 2^-12 of a cell.
inline double grid_coordinate(double value) {
  constexpr double furthest = 0x1p40;
  return value > -furthest ? (value < furthest ? value : furthest) : -furthest;
}

/// Returns the greatest integer that is not greater than `value`, which must be within the range of the result. Faster
/// than std::floor, which is a call of the C library without SSE 4.1.
inline std::int64_t integer_floor(double value) {
  const auto truncated = static_cast<std::int64_t>(value);
  return truncated - static_cast<std::int64_t>(value < static_cast<double>(truncated));
}

}  // namespace cohort
