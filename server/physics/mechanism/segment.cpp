// SPDX-License-Identifier: Apache-2.0
#include "server/physics/mechanism/segment.hpp"

#include "server/physics/mechanism/rotation.hpp"

namespace cohort::physics {

int dofs_of(Motion motion) {
  switch (motion) {
    case Motion::anchored: break;
    case Motion::free: return 6;
    case Motion::revolute:
    case Motion::prismatic: return 1;
    case Motion::ball: return 3;
  }
  return 0;
}

std::span<const double> zero_coordinates_of(Motion motion) {
  static constexpr double place = 0.0;
  static constexpr double rotation[] = {0.0, 0.0, 0.0, 1.0};
  switch (motion) {
    case Motion::anchored:
    case Motion::free: break;
    case Motion::revolute:
    case Motion::prismatic: return {&place, 1};
    case Motion::ball: return rotation;
  }
  return {};
}

int turning_dofs_of(Motion motion) {
  switch (motion) {
    case Motion::anchored:
    case Motion::prismatic: break;
    case Motion::free:
    case Motion::ball: return 3;
    case Motion::revolute: return 1;
  }
  return 0;
}

Pose moved_by_joint(const Segment& segment, const Pose& X_WS, const double* coordinates) {
  Pose moved = X_WS;
  switch (segment.motion) {
    case Motion::free:
    case Motion::anchored: break;
    case Motion::revolute: moved.orientation *= rotation_about(segment.axis_S, coordinates[0]); break;
    case Motion::prismatic: moved.position += coordinates[0] * (moved.orientation * segment.axis_S); break;
    case Motion::ball:
      moved.orientation *= Eigen::Quaterniond(coordinates[3], coordinates[0], coordinates[1], coordinates[2]);
      break;
  }
  return moved;
}

void move_joint(const Segment& segment, const double* v, double step, double* coordinates) {
  switch (segment.motion) {
    case Motion::anchored:
    case Motion::free: break;
    case Motion::revolute:
    case Motion::prismatic: coordinates[0] += step * v[0]; break;
    case Motion::ball: {
      const Eigen::Quaterniond before(coordinates);
      const Eigen::Quaterniond turned = (before * rotation_by(step * Eigen::Vector3d(v[0], v[1], v[2]))).normalized();
      for (int i = 0; i < 4; ++i) coordinates[i] = turned.coeffs()[i];  // x y z w
      break;
    }
  }
}

}  // namespace cohort::physics
