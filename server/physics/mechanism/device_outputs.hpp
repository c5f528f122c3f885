#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "server/core/ids.hpp"
#include "server/description/device_properties.hpp"

namespace cohort::physics {

enum class Side : std::uint8_t { left = 0, right = 1 };

/// What the devices of a model drive beside joints: each device has a list of outputs. A new kind of output is one more
/// alternative of `Output`; the compiler then asks for its `set_target` and its `state`.
struct DeviceOutputs {
  /// One track of a pair that stands on the ground without wheels.
  struct Track {
    std::size_t pair = 0;  ///< its number among `tracks`
    Side side = Side::left;
  };
  struct Wheel {
    int dof = 0;
    double sense = 1.0;  ///< 1: a positive velocity of the joint drives forwards; or -1
  };
  /// The wheels on one side of a pair of tracks, where wheels are simulated.
  struct Wheels {
    std::vector<Wheel> wheels;
    double radius = 0.0;        ///< [m]
    double max_effort = 0.0;    ///< of the motor of each wheel [N m]
    double max_velocity = 0.0;  ///< the same [rad/s]
  };
  /// A belt, by its number among those of the model in the order of the devices.
  struct BeltLink {
    std::size_t index = 0;
  };
  /// A thruster, numbered in the same way.
  struct Propeller {
    std::size_t index = 0;
  };
  using Output = std::variant<Track, Wheels, BeltLink, Propeller>;

  const std::vector<Output>& of(DeviceId device) const { return by_device.at(device.value); }
  /// Throws std::out_of_range for an output that the device does not have.
  const Output& at(DeviceId device, std::size_t output) const { return of(device).at(output); }

  std::vector<std::vector<Output>> by_device;
  std::vector<const description::TrackPair*> tracks;  ///< those that stand on the ground without wheels
};

}  // namespace cohort::physics
