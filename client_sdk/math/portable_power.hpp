// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Powers, and logarithms to bases other than e, for portable_math.cpp. They are computed in double-double arithmetic
/// and rounded once, so that exact results, such as 10^3, are exact.
namespace cohort {

double portable_pow(double x, double y);
double portable_log2(double x);
double portable_log10(double x);

}  // namespace cohort
