// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/include/cohort/controller.hpp"
#include "server/description/model.hpp"
#include "server/description/ros2.hpp"

/// Converts a velocity of a robot's body to speeds of its wheels or tracks, and the readings of its encoders to
/// odometry. The body's frame B is that of the root link: x forward, y left, z up. All wheels roll along x. The origin
/// moves by dx and the body turns by dθ. A wheel at y that turns about the y axis by an angle a then moves by radius *
/// a = dx - dθ * y. Source: Siegwart, Nourbakhsh, Scaramuzza, "Introduction to Autonomous Mobile Robots", 2nd edition,
/// section 3.2.
namespace cohort::ros2 {

/// A velocity of the body in B.
struct BodyVelocity {
  double linear = 0.0;   ///< along x [m/s]
  double angular = 0.0;  ///< about z [rad/s]
};

/// A planar pose and velocity, and the variances of their errors that encoder noise causes.
struct PlanarMotion {
  double x = 0.0, y = 0.0, heading = 0.0;  ///< [m], [m], [rad]
  BodyVelocity velocity{};
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of x, y and heading
  BodyVelocity variance{};                               ///< variances of both velocities [m^2/s^2], [rad^2/s^2]
};

class Drive {
 public:
  /// Returns the drive of a robot: a device that takes velocities of the body, tracks, or velocity motors on left and
  /// right wheels. Returns nullopt if it has none of these. `wheels`, if present, replaces what the model says. Throws
  /// std::runtime_error if `wheels` names channels that the robot does not have.
  static std::optional<Drive> of(const description::Model& model, const Start& robot,
                                 const std::optional<description::Ros2Drive>& wheels);

  /// Sets the commands for this velocity of the body. One factor scales all commands into the channels' ranges, so that
  /// the robot stays on its arc.
  void command(const BodyVelocity& velocity, std::span<double> command) const;

  /// Returns whether the robot has encoders for odometry.
  bool measures() const { return !measured_.empty(); }
  /// Updates the odometry from the encoders' readings, `seconds` after the last call, and returns it. The pose of the
  /// first call, and of the first after `restart`, is the origin.
  const PlanarMotion& measure(std::span<const double> observation, double seconds);
  void restart();

 private:
  friend class DriveFinder;
  // A command channel: value = per_linear * linear + per_angular * angular.
  struct Driven {
    std::size_t offset = 0;
    double per_linear = 0.0;
    double per_angular = 0.0;
    double lower = 0.0;
    double upper = 0.0;
  };
  // An encoder: distance travelled = scale * position = dx - dθ * y.
  struct Measured {
    std::size_t offset = 0;
    double scale = 1.0;
    double y = 0.0;
    double variance = 0.0;  // variance of the distance travelled
    double last = 0.0;
  };
  // Variances of dx and of dθ that the errors of one reading cause.
  struct ReadingVariance {
    double linear = 0.0;
    double angular = 0.0;
  };
  void add_errors(const ReadingVariance& reading, double dx, double direction, double seconds);

  std::vector<Driven> driven_;
  std::vector<Measured> measured_;
  PlanarMotion motion_;
  Eigen::Matrix2d wander_ = Eigen::Matrix2d::Zero();  // covariance of x and y from heading errors so far
  bool has_origin_ = false;
};

}  // namespace cohort::ros2
