// SPDX-License-Identifier: Apache-2.0
#include "server/messages/device_messages.hpp"

#include "server/messages/device_message_list.hpp"

namespace cohort::messages {

std::vector<DeviceMessage> device_messages(const description::Model& model, std::span<const Channel> observation,
                                           const std::optional<GeodeticPlace>& origin) {
  DeviceMessageList list(model, observation, origin);
  const auto add = [&list](const auto& device) {
    if constexpr (requires { add_messages(list, device); }) add_messages(list, device);
  };
  for (const description::Device& device : model.devices) std::visit(add, device);
  add_joint_states(list);
  return list.take();
}

}  // namespace cohort::messages
