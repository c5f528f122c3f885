#pragma once

#include <memory>

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// The sensor of the device at `mount`, or null if it senses nothing.
std::unique_ptr<Sensor> make_sensor(const Mount& mount);

}  // namespace cohort::sensing
