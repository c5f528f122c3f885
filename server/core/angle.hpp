// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace cohort {

/// The greatest absolute value of an angle in an input [rad], 160,000 turns. A greater angle, or NaN, is rejected.
inline constexpr double greatest_angle = 1e6;
inline constexpr const char* angle_range = "from -1e6 to 1e6 rad";  ///< for messages

inline bool is_angle(double radians) { return std::abs(radians) <= greatest_angle; }

}  // namespace cohort
