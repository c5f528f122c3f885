#pragma once

#include <cmath>

namespace cohort::sensing {

/// 2 / (1 + exp(-x)) - 1: how the s-bot's light and sound sensors saturate, from 0 for nothing to 1 (thesis, sections
/// 3.2.3 and 3.2.4).
inline double saturated(double x) { return 2.0 / (1.0 + std::exp(-x)) - 1.0; }

}  // namespace cohort::sensing
