// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

/// Rates at which position errors are corrected, for both kinds of world.
namespace cohort::physics {

/// Fraction of an overlap, an overshoot of a limit or a gap in a connection that is corrected in one step. It is small
/// because the iterative solver may end before convergence, and the error that remains must not be corrected at once.
inline constexpr double correction_share = 0.2;
/// Limits on the velocity that corrects the gap or the rotation error of a joint or a connection.
inline constexpr double most_linear_correction = 0.5;   ///< [m/s]
inline constexpr double most_angular_correction = 5.0;  ///< [rad/s]
/// Returns the velocity that corrects the fraction `share` of the error `off` in one step, clipped to `most`.
inline double correction(double share, double off, double most, double step) {
  return std::clamp(-share * off / step, -most, most);
}
/// Default approach speed below which a contact does not rebound [m/s]. Without it, bodies would never come to rest.
inline constexpr double least_bounce = 0.05;
/// Distance from the origin beyond which a body has left the world [m].
inline constexpr double furthest_from_origin = 1e6;

/// Returns the least separating velocity [m/s] of two surfaces that are `gap` [m] apart: a gap may close within the
/// step, and an overlap is corrected gently.
inline double separating_velocity(double gap, double step) {
  constexpr double gentle = 0.3;
  return gap > 0.0 ? -gap / step : std::min(gentle, -gap * correction_share / step);
}

}  // namespace cohort::physics
