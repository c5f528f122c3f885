// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/make_actuator.hpp"

#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {

std::unique_ptr<Actuator> make_actuator(const Mount& mount) {
  const auto make = [&](const auto& device) -> std::unique_ptr<Actuator> {
    if constexpr (requires { make_actuator(device, mount); }) return make_actuator(device, mount);
    return nullptr;
  };
  return std::visit(make, mount.model().devices[mount.device.value]);
}

}  // namespace cohort::actuation
