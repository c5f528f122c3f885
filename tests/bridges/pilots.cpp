// SPDX-License-Identifier: Apache-2.0
#include "tests/bridges/pilots.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace cohort::test {
namespace {

using Eigen::Vector3d;

constexpr double gravity = 9.81;
constexpr double pi = 3.14159265358979323846;

Vector3d vector_of(const std::array<double, 3>& values) { return {values[0], values[1], values[2]}; }

// The model quadcopter_x has these.
constexpr double mass = 0.716;
constexpr double arm = 0.1202;
constexpr double greatest_thrust = 8.54858e-06 * 838 * 838;  // per rotor [N]
constexpr double moment_constant = 0.016;
const Vector3d inertia(0.007, 0.007, 0.012);

// Left and right output of a vehicle that steers by their difference, at most at `top_speed` [m/s]; within `near` [m]
// of its goal it does not turn any more.
Outputs steer(const Seen& seen, double north, double east, double top_speed, double near) {
  const double to_north = north - seen.position[0], to_east = east - seen.position[1];
  const double distance = std::hypot(to_north, to_east);
  const double yaw = yaw_of(seen);
  const double error = std::remainder(std::atan2(to_east, to_north) - yaw, 2.0 * pi);
  const double wanted = std::min(top_speed, 0.3 * distance) * std::cos(error);
  const double speed = seen.velocity[0] * std::cos(yaw) + seen.velocity[1] * std::sin(yaw);
  const double ahead = (wanted + 0.5 * (wanted - speed)) / top_speed;
  const double turn = distance < near ? 0.0 : std::clamp(error - 0.5 * seen.turn_rate[2], -0.4, 0.4);
  return {0.5 + 0.5 * std::clamp(ahead + turn, -1.0, 1.0), 0.5, 0.5 + 0.5 * std::clamp(ahead - turn, -1.0, 1.0)};
}

}  // namespace

double yaw_of(const Seen& seen) {
  const auto& [w, x, y, z] = seen.attitude;
  return std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
}

Outputs hover_at_two_metres(const Seen& seen) {
  if (seen.time < 0.5) return {0, 0, 0, 0};
  // Half a metre north and west of where each of the two stood.
  const Vector3d target(seen.position[0] < -1.5 ? -2.5 : 0.5, -0.5, -2.0);
  const auto& [w, x, y, z] = seen.attitude;
  const Eigen::Quaterniond R(w, x, y, z);
  Vector3d wanted = 2.0 * (target - vector_of(seen.position)) - 2.5 * vector_of(seen.velocity);
  wanted = wanted.cwiseMax(-3.0).cwiseMin(3.0);
  // Thrust is along -z of the body.
  const Vector3d force = Vector3d(0, 0, gravity) - wanted;
  const double thrust = mass * force.dot(R * Vector3d::UnitZ());
  const Vector3d tilt = R.conjugate() * (R * Vector3d::UnitZ()).cross(force.normalized());
  Vector3d moment = 64.0 * tilt - 14.0 * vector_of(seen.turn_rate);
  moment.z() = 4.0 * std::remainder(-yaw_of(seen), 2.0 * pi) - 4.0 * seen.turn_rate[2];
  moment = moment.cwiseProduct(inertia);
  // Front right, rear left, front left, rear right.
  const double signs[4][3] = {{-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, -1}};
  Outputs outputs;
  for (const auto& [roll, pitch, yaw] : signs) {
    const double each = thrust / 4 + roll * moment.x() / (4 * arm) + pitch * moment.y() / (4 * arm) +
                        yaw * moment.z() / (4 * moment_constant);
    outputs.push_back(std::sqrt(std::clamp(each / greatest_thrust, 0.0, 1.0)));
  }
  return outputs;
}

Outputs drive_to_the_north(const Seen& seen) { return steer(seen, 1.0, 0.5, 0.25, 0.05); }

Outputs cross_the_water(const Seen& seen) { return steer(seen, 8.0, 6.0, 1.3, 0.5); }

}  // namespace cohort::test
