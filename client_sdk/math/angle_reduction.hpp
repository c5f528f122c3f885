#pragma once

namespace cohort {

/// An angle as n quarter turns and a rest from -pi/4 to pi/4, which is value + tail. `quadrant`: n modulo 4.
struct ReducedAngle {
  int quadrant;
  double value;
  double tail;
};

/// Reduces any finite angle. Tail and value have at least 70 correct bits.
ReducedAngle reduce_exactly(double x);

}  // namespace cohort
