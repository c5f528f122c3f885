// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/messages/device_message.hpp"

namespace cohort::messages {

/// Returns the messages of a model's devices in the order of the devices, followed by the states of all joints with
/// encoders. `observation` has the channels of its robots. `origin` is the geodetic position of the world's origin;
/// without it, satellite receivers report positions in the world. Throws std::logic_error if the channels belong to
/// another model.
std::vector<DeviceMessage> device_messages(const description::Model& model, std::span<const Channel> observation,
                                           const std::optional<GeodeticPlace>& origin = {});

}  // namespace cohort::messages
