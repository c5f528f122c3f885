// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// Returns the actuator of the device at `mount`, or null if the device is only a sensor.
std::unique_ptr<Actuator> make_actuator(const Mount& mount);

}  // namespace cohort::actuation
