// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Returns the sensor of the device at `mount`, or null if the device has none.
std::unique_ptr<Sensor> make_sensor(const Mount& mount);

}  // namespace cohort::sensing
