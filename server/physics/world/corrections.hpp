#pragma once

#include <algorithm>

/// How fast what came apart or into each other is put right, for both kinds of world.
namespace cohort::physics {

/// Share of an overlap, of an overshoot or of a gap in a connection that one step takes away.
inline constexpr double correction_share = 0.2;
/// Nothing that came apart is pulled together, or turned back, faster than this.
inline constexpr double most_linear_correction = 0.5;   ///< [m/s]
inline constexpr double most_angular_correction = 5.0;  ///< [rad/s]
/// The velocity that takes away a share of what is `off`.
inline double correction(double off, double most, double step) {
  return std::clamp(-correction_share * off / step, -most, most);
}
/// Slower than this nothing bounces whose surface does not say [m/s]: what rests would never come to rest.
inline constexpr double least_bounce = 0.05;
/// Further from the origin a body has left the world [m].
inline constexpr double furthest_from_origin = 1e6;

/// Velocity with which two surfaces that are `gap` [m] apart have to come apart at least [m/s]: they may close a gap
/// within the step, and an overlap is pushed out gently.
inline double separating_velocity(double gap, double step) {
  constexpr double gentle = 0.3;
  return gap > 0.0 ? -gap / step : std::min(gentle, -gap * correction_share / step);
}

}  // namespace cohort::physics
