// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tools/bridges/autopilots/vehicle_motion.hpp"
#include "tools/bridges/mavlink/hil_messages.hpp"

/// Messages to PX4 about a vehicle (docs/bridges/px4.md). Pure functions.
namespace cohort::px4 {

/// Returns the sensor measurements at a time [us]. `magnetic_field` is in FRD [T]. `pressure` [Pa] is that of a
/// barometer with altitude 0 at the world's origin; the message contains the pressure at an altitude that is higher by
/// that of `home`.
mavlink::HilSensor sensor_message(std::uint64_t time, const autopilots::Motion& motion,
                                  const autopilots::Vector3& magnetic_field, double pressure,
                                  const autopilots::Geodetic& home);
mavlink::HilGps gps_message(std::uint64_t time, const autopilots::Motion& motion, const autopilots::Geodetic& home);
mavlink::HilStateQuaternion state_message(std::uint64_t time, const autopilots::Motion& motion,
                                          const autopilots::Geodetic& home);

}  // namespace cohort::px4
