// SPDX-License-Identifier: Apache-2.0
#include "server/physics/planar/planar_ground.hpp"

#include <algorithm>

#include "server/core/plane_vectors.hpp"

namespace cohort::physics {
namespace {

using Eigen::Vector2d;

double speed_along(const Vector2d& direction, double lever, const PlanarVelocity& velocity) {
  return direction.x() * velocity.x + direction.y() * velocity.y + lever * velocity.spin;
}
void push(double impulse, const Vector2d& direction, double lever, const PlanarInertia& inertia,
          PlanarVelocity& velocity) {
  velocity.x += impulse * inertia.inverse_mass * direction.x();
  velocity.y += impulse * inertia.inverse_mass * direction.y();
  velocity.spin += impulse * inertia.inverse_inertia * lever;
}

}  // namespace

PlanarGround::PlanarGround(const description::TrackPair& drive, const Pose& X_BL, double friction, double weight,
                           const PlanarInertia& inertia, double step)
    : is_drive_(true), motor_limit_(drive.max_torque / drive.wheel_radius * step) {
  forward_B_ = (X_BL.orientation * Eigen::Vector3d::UnitX()).head<2>().normalized();
  const auto point = [&](double y) -> Vector2d {
    return (X_BL * Eigen::Vector3d(0.0, y, drive.ground_height)).head<2>();
  };
  const double grip = friction * weight * step;
  rows_[0] = {cross(point(drive.half_gauge), forward_B_), 0.0, 0.0, std::min(motor_limit_, 0.5 * grip)};
  rows_[1] = {cross(point(-drive.half_gauge), forward_B_), 0.0, 0.0, std::min(motor_limit_, 0.5 * grip)};
  rows_[2] = {cross(point(0.0), left_of(forward_B_)), 0.0, 0.0, grip};
  for (Row& row : rows_) {
    row.mobility = inertia.inverse_mass + row.lever * row.lever * inertia.inverse_inertia;
    row.mass = row.mobility > 0.0 ? 1.0 / row.mobility : 0.0;
  }
  coupling_ = inertia.inverse_mass + rows_[0].lever * rows_[1].lever * inertia.inverse_inertia;
  const double determinant = rows_[0].mobility * rows_[1].mobility - coupling_ * coupling_;
  if (determinant > 0.0) inverse_determinant_ = 1.0 / determinant;
}

PlanarGround::PlanarGround(double friction, double weight, double arm, double step) {
  const double grip = friction * weight * step;
  rows_[0].limit = rows_[1].limit = grip;
  rows_[2].limit = grip * arm;
}

void PlanarGround::begin(const PlanarPlace& place, const PlanarInertia& inertia, PlanarVelocity& velocity) {
  if (!is_drive_) {
    velocity.x += impulse_[0] * inertia.inverse_mass;
    velocity.y += impulse_[1] * inertia.inverse_mass;
    velocity.spin += impulse_[2] * inertia.inverse_inertia;
    return;
  }
  forward_W_ = place.rotate(forward_B_);
  push(impulse_[0], forward_W_, rows_[0].lever, inertia, velocity);
  push(impulse_[1], forward_W_, rows_[1].lever, inertia, velocity);
  push(impulse_[2], left_of(forward_W_), rows_[2].lever, inertia, velocity);
}

double PlanarGround::solve(const PlanarInertia& inertia, PlanarVelocity& velocity) {
  if (!is_drive_) return solve_patch(inertia, velocity);
  double change = 0.0;
  if (!solve_tracks(inertia, velocity, change)) {
    change = solve_row(0, tracks_[0].target, forward_W_, inertia, velocity);
    change = std::max(change, solve_row(1, tracks_[1].target, forward_W_, inertia, velocity));
  }
  return std::max(change, solve_row(2, 0.0, left_of(forward_W_), inertia, velocity));
}

bool PlanarGround::solve_tracks(const PlanarInertia& inertia, PlanarVelocity& velocity, double& change) {
  if (inverse_determinant_ == 0.0) return false;
  const double missing_left = tracks_[0].target - speed_along(forward_W_, rows_[0].lever, velocity);
  const double missing_right = tracks_[1].target - speed_along(forward_W_, rows_[1].lever, velocity);
  const double left = (missing_left * rows_[1].mobility - coupling_ * missing_right) * inverse_determinant_;
  const double right = (missing_right * rows_[0].mobility - coupling_ * missing_left) * inverse_determinant_;
  if (std::abs(impulse_[0] + left) > rows_[0].limit || std::abs(impulse_[1] + right) > rows_[1].limit) return false;
  impulse_[0] += left;
  impulse_[1] += right;
  velocity.x += (left + right) * inertia.inverse_mass * forward_W_.x();
  velocity.y += (left + right) * inertia.inverse_mass * forward_W_.y();
  velocity.spin += (left * rows_[0].lever + right * rows_[1].lever) * inertia.inverse_inertia;
  change = std::max(std::abs(left), std::abs(right)) * inertia.inverse_mass;
  return true;
}

double PlanarGround::solve_row(std::size_t index, double target, const Vector2d& direction_W,
                               const PlanarInertia& inertia, PlanarVelocity& velocity) {
  const Row& row = rows_[index];
  const double missing = target - speed_along(direction_W, row.lever, velocity);
  const double before = impulse_[index];
  impulse_[index] = std::clamp(before + row.mass * missing, -row.limit, row.limit);
  const double change = impulse_[index] - before;
  if (change == 0.0) return 0.0;
  push(change, direction_W, row.lever, inertia, velocity);
  return std::abs(change) * inertia.inverse_mass;
}

double PlanarGround::solve_patch(const PlanarInertia& inertia, PlanarVelocity& velocity) {
  if (inertia.inverse_mass == 0.0 || rows_[0].limit == 0.0) return 0.0;
  // The impulse that would stop the body, reduced to what the ground can give.
  std::array<double, 3> wanted{impulse_[0] - velocity.x / inertia.inverse_mass,
                               impulse_[1] - velocity.y / inertia.inverse_mass,
                               impulse_[2] - velocity.spin / inertia.inverse_inertia};
  double load = 0.0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (rows_[i].limit == 0.0) {
      wanted[i] = 0.0;
    } else {
      load += wanted[i] * wanted[i] / (rows_[i].limit * rows_[i].limit);
    }
  }
  if (load > 1.0)
    for (double& impulse : wanted) impulse /= std::sqrt(load);
  const double x = (wanted[0] - impulse_[0]) * inertia.inverse_mass;
  const double y = (wanted[1] - impulse_[1]) * inertia.inverse_mass;
  const double spin = (wanted[2] - impulse_[2]) * inertia.inverse_inertia;
  velocity.x += x;
  velocity.y += y;
  velocity.spin += spin;
  impulse_ = wanted;
  return std::max({std::abs(x), std::abs(y), std::abs(spin)});
}

void PlanarGround::finish(const PlanarVelocity& velocity, double step) {
  if (!is_drive_) return;
  for (std::size_t side = 0; side < tracks_.size(); ++side) {
    Track& track = tracks_[side];
    const Row& row = rows_[side];
    // As in the full model, a slipping track moves as commanded and a gripping one follows the ground.
    const bool slips = row.limit < motor_limit_ && std::abs(impulse_[side]) >= row.limit;
    track.state.velocity = slips ? track.target : speed_along(forward_W_, row.lever, velocity);
    track.state.position += track.state.velocity * step;
    track.state.effort = impulse_[side] / step;
  }
}

}  // namespace cohort::physics
