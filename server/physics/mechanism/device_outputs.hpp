// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "server/core/ids.hpp"
#include "server/description/device_properties.hpp"

namespace cohort::physics {

enum class Side : std::uint8_t { left = 0, right = 1 };

/// The outputs of a model's devices: what they drive other than joints, as one list for each device. A new kind of
/// output is one more alternative of `Output`; the compiler then requires its `set_target` and its `state`.
struct DeviceOutputs {
  /// One track of a pair that stands on the ground without wheels (treels).
  struct Track {
    std::size_t pair = 0;  ///< its number among `tracks`
    Side side = Side::left;
  };
  struct Wheel {
    int dof = 0;
    double sense = 1.0;  ///< 1: a positive velocity of the joint drives forwards; or -1
  };
  /// The wheels on one side of a pair of tracks, if wheels are simulated.
  struct Wheels {
    std::vector<Wheel> wheels;
    double radius = 0.0;        ///< [m]
    double max_effort = 0.0;    ///< torque of each wheel's motor [N m]
    double max_velocity = 0.0;  ///< speed of each wheel's motor [rad/s]
  };
  /// A belt, by its number among the model's belts in the order of the devices.
  struct BeltLink {
    std::size_t index = 0;
  };
  /// A thruster, numbered in the same way.
  struct Propeller {
    std::size_t index = 0;
  };
  using Output = std::variant<Track, Wheels, BeltLink, Propeller>;

  const std::vector<Output>& of(DeviceId device) const { return by_device.at(device.value); }
  /// Returns an output; throws std::out_of_range if the device does not have it.
  const Output& at(DeviceId device, std::size_t output) const { return of(device).at(output); }

  std::vector<std::vector<Output>> by_device;
  std::vector<const description::TrackPair*> tracks;  ///< those that stand on the ground without wheels
};

}  // namespace cohort::physics
