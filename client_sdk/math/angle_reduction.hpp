// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort {

/// An angle as n quarter turns plus a remainder from -pi/4 to pi/4, which is value + tail [rad]. `quadrant` is n modulo
/// 4.
struct ReducedAngle {
  int quadrant;
  double value;
  double tail;
};

/// Reduces any finite angle [rad]. The sum value + tail has at least 70 correct bits.
ReducedAngle reduce_exactly(double x);

}  // namespace cohort
