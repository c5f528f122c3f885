// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace cohort::sensing {

/// Returns 2 / (1 + exp(-x)) - 1: the saturation of the s-bot's light and sound sensors, from 0 to 1 (thesis, sections
/// 3.2.3 and 3.2.4).
inline double saturated(double x) { return 2.0 / (1.0 + std::exp(-x)) - 1.0; }

}  // namespace cohort::sensing
