// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>

#include "server/description/model.hpp"
#include "server/physics/mechanism/ground.hpp"
#include "server/physics/world/anchors.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/physics/world/surface_pairs.hpp"

namespace cohort::physics {

class Problem;

/// Both tracks of a robot, without wheels (treels), in 7 rows. Up to four ground points under the root link support it;
/// each side has one drive row, and one row acts against lateral sliding. Traction is limited by the motor and by
/// friction under the normal impulses of the same iteration. Simulated wheels need four times as many rows. A robot
/// with treels that is commanded to stand still does not creep.
class TrackRows {
 public:
  /// `X_SL`: pose of the drive's link in the root segment.
  TrackRows(const description::Model& model, const description::TrackPair& drive, const Pose& X_SL)
      : drive_(&drive), surface_(surface_of_tracks(model, drive)), X_SL_(X_SL) {}

  /// Sets the target velocity of a track; returns whether it changed.
  bool set_target(Side side, double velocity) { return std::exchange(side_of(side).target, velocity) != velocity; }
  const OutputState& track(Side side) const { return side_of(side).state; }

  /// Returns the region that is searched for ground. `X_WS`: pose of the root segment.
  geometry::Bounds ground_region(const Pose& X_WS) const;
  /// Finds the ground under each ground point. `candidates`: the solids of other bodies in the ground region.
  void find_ground(const geometry::Scene& scene, const SurfacePairs& surfaces, const Pose& X_WS,
                   std::span<const std::uint32_t> candidates);
  /// Stores the surface velocity of the ground, which is zero except on belts. `velocity_of(ground)`: relative to the
  /// body of the ground [m/s].
  template <class VelocityOf>
  void find_belts(const VelocityOf& velocity_of) {
    for (Point& point : points_)
      if (point.ground) point.running_W = velocity_of(*point.ground);
  }
  /// Calls `visit(solid)` for each solid found as ground.
  template <class Visit>
  void for_each_ground(Visit&& visit) const {
    for (const Point& point : points_)
      if (point.ground) visit(point.ground->solid);
  }

  /// Returns the link that carries the tracks.
  std::size_t link() const { return drive_->link; }
  /// Calls `visit(solid, point_W, impulse_W)` for each impulse on the link in the last step by a solid under the tracks
  /// [N s].
  template <class Visit>
  void for_each_impulse(Visit&& visit) const;

  /// Returns the mean upward normal of the ground, or zero if there is none.
  Eigen::Vector3d up() const {
    const std::optional<Directions> along = directions();
    return along ? Eigen::Vector3d(along->forward_W.cross(along->left_W)) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }

  void add_rows(Problem& problem, int index, const Anchors& anchors, double step);
  /// Reads the state of the tracks from the solved rows.
  void read_rows(const Problem& problem, double step);

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    for (auto& track : self.tracks_) {
      visit(track.target);
      visit(track.state.position);
      visit(track.state.velocity);
      visit(track.state.effort);
      visit(track.impulse);
    }
    for (auto& point : self.points_) visit(point.impulse);
    visit(self.lateral_impulse_);
  }

 private:
  struct Track {
    double target = 0.0;
    OutputState state;
    double impulse = 0.0;  // drive row
    int row = -1;          // drive row in this step; -1: no ground point of this side touches
    double carried = 0.0;  // forward velocity of the surface under it in this step [m/s]
  };
  struct Point {
    double impulse = 0.0;
    // Data of this step:
    Eigen::Vector3d position_W = Eigen::Vector3d::Zero();
    std::optional<Ground> ground;
    double friction = 0.0;  // with the ground
    Eigen::Vector3d running_W = Eigen::Vector3d::Zero();
  };
  /// Directions along the ground in this step: forwards and to the left of the tracks.
  struct Directions {
    Eigen::Vector3d forward_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d left_W = Eigen::Vector3d::Zero();
  };
  std::optional<Directions> directions() const;
  /// Returns the solid under a side; of two solids, the one under its rear end.
  std::optional<std::uint32_t> solid_under(Side side) const;
  Eigen::Vector3d point_of(Side side) const { return X_WL_ * Eigen::Vector3d(0.0, y_of(side), drive_->ground_height); }
  Eigen::Vector3d middle() const { return X_WL_ * Eigen::Vector3d(0.0, 0.0, drive_->ground_height); }
  Track& side_of(Side side) { return tracks_[static_cast<std::size_t>(side)]; }
  const Track& side_of(Side side) const { return tracks_[static_cast<std::size_t>(side)]; }
  double y_of(Side side) const { return side == Side::left ? drive_->half_gauge : -drive_->half_gauge; }

  const description::TrackPair* drive_;  // owned by the model
  description::Surface surface_;
  Pose X_SL_;
  std::array<Track, 2> tracks_;
  std::array<Point, 4> points_;  // left front, left rear, right front, right rear
  double lateral_impulse_ = 0.0;
  Pose X_WL_;  // in this step
};

template <class Visit>
void TrackRows::for_each_impulse(Visit&& visit) const {
  for (const Point& point : points_)
    if (point.ground)
      visit(point.ground->solid, point.position_W, Eigen::Vector3d(point.impulse * point.ground->normal_W));
  const std::optional<Directions> along = directions();
  if (!along) return;
  for (const Side side : {Side::left, Side::right})
    if (const std::optional<std::uint32_t> solid = solid_under(side))
      visit(*solid, point_of(side), Eigen::Vector3d(side_of(side).impulse * along->forward_W));
  const std::optional<std::uint32_t> left = solid_under(Side::left);
  visit(left ? *left : *solid_under(Side::right), middle(), Eigen::Vector3d(lateral_impulse_ * along->left_W));
}

}  // namespace cohort::physics
