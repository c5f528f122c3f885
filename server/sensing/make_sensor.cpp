// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/make_sensor.hpp"

#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {

std::unique_ptr<Sensor> make_sensor(const Mount& mount) {
  const auto make = [&](const auto& device) -> std::unique_ptr<Sensor> {
    if constexpr (requires { make_sensor(device, mount); }) return make_sensor(device, mount);
    return nullptr;
  };
  return std::visit(make, mount.model().devices[mount.device.value]);
}

}  // namespace cohort::sensing
