// SPDX-License-Identifier: Apache-2.0
#include "server/physics/multibody/track_rows.hpp"

#include <algorithm>

#include "server/core/infinity.hpp"
#include "server/physics/multibody/rows.hpp"
#include "server/physics/world/corrections.hpp"

namespace cohort::physics {
namespace {

// A ground point is active from this height above the surface, so that a landing is detected before it happens [m].
constexpr double reach = 0.01;

constexpr std::array sides{Side::left, Side::right};

}  // namespace

geometry::Bounds TrackRows::ground_region(const Pose& X_WS) const {
  const Eigen::Matrix3d R = (X_WS.orientation * X_SL_.orientation).toRotationMatrix();
  const double rise = 0.5 * (drive_->wheel_radius + reach);
  const Eigen::Vector3d centre_W =
      X_WS * X_SL_.position + (drive_->ground_height + 0.5 * (drive_->wheel_radius - reach)) * R.col(2);
  const Eigen::Vector3d half_W = R.cwiseAbs() * Eigen::Vector3d(drive_->half_contact_length, drive_->half_gauge, rise);
  return {centre_W - half_W, centre_W + half_W};
}

void TrackRows::find_ground(const geometry::Scene& scene, const SurfacePairs& surfaces, const Pose& X_WS,
                            std::span<const std::uint32_t> candidates) {
  X_WL_ = X_WS * X_SL_;
  const Eigen::Matrix3d R = X_WL_.orientation.toRotationMatrix();
  const Eigen::Vector3d centre_W = X_WL_.position + drive_->ground_height * R.col(2);
  const GroundFinder finder(scene, candidates, R.col(2), drive_->wheel_radius, reach);
  std::size_t i = 0;
  for (const Side side : sides) {
    for (const double end : {drive_->half_contact_length, -drive_->half_contact_length}) {
      // A track that extends over an edge or a gap stands on its outermost part with ground under it.
      Point& point = points_[i++];
      for (const double share : {1.0, 0.5, 0.0}) {
        point.position_W = centre_W + share * end * R.col(0) + y_of(side) * R.col(1);
        point.ground = finder.below(point.position_W);
        if (point.ground) break;
      }
      if (point.ground) point.friction = surfaces.of(surface_, scene.solid(point.ground->solid).surface()).friction;
    }
  }
}

std::optional<TrackRows::Directions> TrackRows::directions() const {
  Eigen::Vector3d normal_sum = Eigen::Vector3d::Zero();
  for (const Point& point : points_)
    if (point.ground) normal_sum += point.ground->normal_W;
  if (normal_sum.isZero()) return std::nullopt;
  const Eigen::Vector3d normal_W = normal_sum.normalized();
  const Eigen::Vector3d x_W = X_WL_.orientation * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d forward_W = (x_W - normal_W.dot(x_W) * normal_W).normalized();
  return Directions{forward_W, normal_W.cross(forward_W)};
}

std::optional<std::uint32_t> TrackRows::solid_under(Side side) const {
  const std::size_t front = 2 * static_cast<std::size_t>(side);
  const std::optional<Ground>& rear = points_[front + 1].ground;
  if (rear) return rear->solid;
  if (points_[front].ground) return points_[front].ground->solid;
  return std::nullopt;
}

void TrackRows::add_rows(Problem& problem, int index, const Anchors& anchors, double step) {
  const Anchor hull{index, 0};
  const int first = problem.row_count();
  std::array<int, 3> begin{first, first, first};  // normal rows of each side, and one past the last
  std::array<double, 2> friction{infinity, infinity};
  std::array<Anchor, 2> under;               // the ground of each track; of two solids, the rear one
  std::array<Eigen::Vector3d, 2> running_W;  // its surface velocity
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::size_t side = i / 2;
    Point& point = points_[i];
    if (!point.ground) {
      point.impulse = 0.0;
    } else {
      const Ground& ground = *point.ground;
      under[side] = anchors.of(ground.solid);
      running_W[side] = point.running_W;
      friction[side] = std::min(friction[side], point.friction);
      Row& row = problem.add_force_row(hull, under[side], point.position_W, ground.normal_W, &point.impulse);
      row.target = separating_velocity(ground.gap, step);
      row.set_limits(0.0, unlimited);
    }
    begin[side + 1] = problem.row_count();
  }

  for (Track& track : tracks_) track.row = -1;
  if (const std::optional<Directions> along = directions()) {
    for (const Side side : sides) {
      const auto s = static_cast<std::size_t>(side);
      if (begin[s] == begin[s + 1]) continue;
      Track& track = tracks_[s];
      track.row = problem.row_count();
      Row& row = problem.add_force_row(hull, under[s], point_of(side), along->forward_W, &track.impulse);
      track.carried = along->forward_W.dot(running_W[s]);
      row.target = track.target + track.carried;
      row.limits = Row::Limits::friction;
      row.friction = friction[s];
      row.cap = drive_->max_torque / drive_->wheel_radius * step;
      row.load_begin = begin[s];
      row.load_end = begin[s + 1];
    }
    const std::size_t stands = tracks_[0].row >= 0 ? 0 : 1;
    Row& row = problem.add_force_row(hull, under[stands], middle(), along->left_W, &lateral_impulse_);
    row.target = along->left_W.dot(running_W[stands]);
    row.limits = Row::Limits::friction;
    row.friction = std::min(friction[0], friction[1]);
    row.load_begin = begin[0];
    row.load_end = begin[2];
  } else {
    lateral_impulse_ = 0.0;
  }
  for (Track& track : tracks_)
    if (track.row < 0) track.impulse = 0.0;
}

void TrackRows::read_rows(const Problem& problem, double step) {
  for (Track& track : tracks_) {
    track.state.velocity = track.target;  // a slipping or airborne track moves as commanded
    if (track.row >= 0) {
      const Row& row = problem.rows()[static_cast<std::size_t>(track.row)];
      const bool slips = row.upper < row.cap && std::abs(row.impulse) >= row.upper;
      if (!slips) track.state.velocity = problem.velocity(row) - track.carried;  // a gripping track follows the ground
    }
    track.state.position += track.state.velocity * step;
    track.state.effort = track.impulse / step;
  }
}

}  // namespace cohort::physics
