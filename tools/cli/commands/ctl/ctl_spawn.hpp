// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client_sdk/include/cohort/control.hpp"

namespace cohort::tool {

/// Spawns a model file, a model of the world, or a model that is installed with Cohort, also as model://NAME. Throws
/// ControlError, and std::invalid_argument if there is no such file.
ControlReply spawn_model(Control& control, Spawn what);

}  // namespace cohort::tool
