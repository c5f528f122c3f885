// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

namespace cohort::test {

/// An autopilot's estimate of the state of its vehicle: north-east-down and forward-right-down.
struct Seen {
  double time = 0.0;                  // [s]
  std::array<double, 3> turn_rate{};  // [rad/s]
  std::array<double, 3> position{};   // [m]
  std::array<double, 3> velocity{};   // [m/s]
  std::array<double, 4> attitude{1};  // w x y z, from forward-right-down to north-east-down
};

/// Outputs from 1 on, each between 0 and 1.
using Outputs = std::vector<double>;

/// Control laws that stand for those of an autopilot, functions of what they see.
using Pilot = Outputs (*)(const Seen& seen);

/// Rises to 2 m above the ground and hovers there, half a metre north and west of where it stood, looking north; its
/// motors rest for half a second.
Outputs hover_at_two_metres(const Seen& seen);

/// Drives two wheels to 1 m north and 0.5 m east of the origin.
Outputs drive_to_the_north(const Seen& seen);

/// Steers a boat with two thrusters to 8 m north and 6 m east of the origin.
Outputs cross_the_water(const Seen& seen);

/// [rad], clockwise from north.
double yaw_of(const Seen& seen);

/// A vehicle at the end of its run, after so many steps of its pilot.
struct Flown {
  Seen seen;
  int steps = 0;
  std::string hash{};
};

}  // namespace cohort::test
