#pragma once

#include <vector>

#include "server/messages/device_message.hpp"

namespace cohort::messages {

/// Returns the messages of a model's devices in the order of the devices, followed by the states of all joints with
/// encoders. `observation` has the channels of its robots. `origin` is that of the world, for satellite receivers;
/// without it, they have no latitudes. Throws std::logic_error if the channels are those of another model.
std::vector<DeviceMessage> device_messages(const description::Model& model, std::span<const Channel> observation,
                                           const std::optional<GeodeticPlace>& origin = {});

}  // namespace cohort::messages
