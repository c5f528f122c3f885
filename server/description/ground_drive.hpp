// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "server/description/model.hpp"

namespace cohort::description {

/// A command channel that drives a robot over the ground, with its values at full speed.
struct DriveChannel {
  std::string channel;
  double ahead = 0.0;  ///< value that drives forward, in the unit of the channel
  double turn = 0.0;   ///< value that turns counter-clockwise on the spot
  bool operator==(const DriveChannel&) const = default;
};

/// Returns the command channels by which a person drives a robot forward and turns it, in the order of its devices;
/// none if it has no such drive. The first of these that the model has is used:
///
/// - a drive whose command is a twist (DifferentialDrive, AckermannDrive, TrackedDrive);
/// - a TreelDrive;
/// - belts and wheels on both sides. A wheel is a link that a VelocityMotor turns without limits about a horizontal
///   axis, and that reaches down as far as the others. All axes must be parallel.
///
/// Names have no influence. In the model's frame M, z is up and x is forward; if the axes lie along x, y is forward.
/// The line midway between the outermost wheels separates the left side from the right. All wheels move at the same
/// speed over the ground. A drive without a limit gets 1 m/s and 1 rad/s.
std::vector<DriveChannel> ground_drive(const Model& model);

}  // namespace cohort::description
