#pragma once

#include <cstdint>

#include "tools/bridges/autopilots/vehicle_motion.hpp"
#include "tools/bridges/mavlink/hil_messages.hpp"

/// Messages to PX4 about a vehicle (docs/bridges/px4.md). Pure functions.
namespace cohort::px4 {

/// `magnetic_field`: FRD [T]. `pressure`: that of a barometer whose reference altitude is 0 at the world's origin [Pa];
/// PX4 gets the pressure that is as much higher as `home`.
mavlink::HilSensor sensor_message(std::uint64_t time, const autopilots::Motion& motion,
                                  const autopilots::Vector3& magnetic_field, double pressure,
                                  const autopilots::Geodetic& home);
mavlink::HilGps gps_message(std::uint64_t time, const autopilots::Motion& motion, const autopilots::Geodetic& home);
mavlink::HilStateQuaternion state_message(std::uint64_t time, const autopilots::Motion& motion,
                                          const autopilots::Geodetic& home);

}  // namespace cohort::px4
