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
/// odometry. The body's frame B is that of the root link: x forward, y left, z up. All wheels roll along x. The
/// origin moves by dx and the body turns by dθ. A wheel at y that turns about the y axis by an angle a then moves by
/// radius * a = dx - dθ * y. Source: Siegwart, Nourbakhsh, Scaramuzza, "Introduction to Autonomous Mobile Robots", 2nd
/// edition, section 3.2.
namespace cohort::ros2 {

/// A velocity of the body in B.
struct BodyVelocity {
  double linear = 0.0;   ///< along x [m/s]
  double angular = 0.0;  ///< about z [rad/s]
};

/// A pose in the plane, the velocity there, and the variances of their errors that the noise of encoders causes.
struct PlanarMotion {
  double x = 0.0, y = 0.0, heading = 0.0;  ///< [m], [m], [rad]
  BodyVelocity velocity{};
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of x, y and heading
  BodyVelocity variance{};                               ///< variances of both velocities [m^2/s^2], [rad^2/s^2]
};

class Drive {
 public:
  /// Finds out how a robot is driven: by a device that takes velocities of the body, by tracks, or by velocity motors
  /// on wheels left and right. `wheels`, if there, says it instead of the model. Nothing if it is not driven so. Throws
  /// std::runtime_error if `wheels` names channels that the robot has not.
  static std::optional<Drive> of(const description::Model& model, const Start& robot,
                                 const std::optional<description::Ros2Drive>& wheels);

  /// Sets the commands that move the body so. They are kept within the channels' ranges, by one factor for all, so
  /// that the robot stays on its arc.
  void command(const BodyVelocity& velocity, std::span<double> command) const;

  /// Returns whether the robot has encoders that tell its way.
  bool measures() const { return !measured_.empty(); }
  /// Takes what encoders say now. `seconds`: since the last call. The first call, and the first after `restart`, is
  /// the origin.
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
  // An observed position: way = scale * position = dx - dθ * y.
  struct Measured {
    std::size_t offset = 0;
    double scale = 1.0;
    double y = 0.0;
    double variance = 0.0;  // variance of the way
    double last = 0.0;
  };
  // Variances of the origin's way and of the turn by errors of one reading.
  struct ReadingVariance {
    double linear = 0.0;
    double angular = 0.0;
  };
  void add_errors(const ReadingVariance& reading, double dx, double direction, double seconds);

  std::vector<Driven> driven_;
  std::vector<Measured> measured_;
  PlanarMotion motion_;
  Eigen::Matrix2d wander_ = Eigen::Matrix2d::Zero();  // covariance of x and y by the directions of all steps so far
  bool has_origin_ = false;
};

}  // namespace cohort::ros2
