#pragma once

#include <memory>

#include "server/actuation/actuator.hpp"

namespace cohort::actuation {

/// The actuator of the device at `mount`, or null if it only senses.
std::unique_ptr<Actuator> make_actuator(const Mount& mount);

}  // namespace cohort::actuation
