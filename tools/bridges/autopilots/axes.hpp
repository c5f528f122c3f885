// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

/// Conversions to the frames of autopilots: north-east-down (NED) and forward-right-down (FRD). The frames of a world
/// are x east, y north, z up; those of a model are x forward, y left, z up.
namespace cohort::autopilots {

using Vector3 = std::array<double, 3>;

/// w x y z.
using Quaternion = std::array<double, 4>;

/// Converts from east-north-up.
inline Vector3 to_ned(std::span<const double> enu) { return {enu[1], enu[0], -enu[2]}; }

/// Converts from forward-left-up.
inline Vector3 to_frd(std::span<const double> flu) { return {flu[0], -flu[1], -flu[2]}; }

/// Returns the rotation from FRD to NED (w x y z, w >= 0), given the rotation q from FLU to ENU (x y z w). The result
/// is q_NED_ENU q q_FLU_FRD with q_NED_ENU = (0, s, s, 0), q_FLU_FRD = (0, 1, 0, 0) and s = sqrt(1/2).
Quaternion frd_to_ned(std::span<const double> flu_to_enu);

/// A place on Earth.
struct Geodetic {
  double latitude = 0.0;   ///< [degrees]
  double longitude = 0.0;  ///< [degrees]
  double altitude = 0.0;   ///< above mean sea level [m]
};

/// Returns the place at the offset `ned` [m] from `home`, by the azimuthal equidistant projection on a sphere of 6371
/// km. This is the inverse of PX4's own (src/lib/geo/geo.cpp, MapProjection::reproject), so PX4's estimate agrees with
/// the vehicle.
Geodetic place_of(const Geodetic& home, const Vector3& ned);

/// Returns the altitude [m] of a pressure [Pa] in the lowest layer of the International Standard Atmosphere (ICAO Doc
/// 7488).
double pressure_altitude(double pressure);
/// Returns the pressure [Pa] at an altitude [m] in the same layer.
double pressure_at(double altitude);

}  // namespace cohort::autopilots
