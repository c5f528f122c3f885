#pragma once

#include <cstdint>

namespace cohort {

/// Returns the greatest integer that is not greater than `value`, which must be within the range of the result. Without
/// SSE 4.1, std::floor is a call of the C library.
inline std::int64_t integer_floor(double value) {
  const auto truncated = static_cast<std::int64_t>(value);
  return truncated - static_cast<std::int64_t>(value < static_cast<double>(truncated));
}

}  // namespace cohort
