// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "server/physics/planar/planar_bodies.hpp"

namespace cohort::physics {

/// The force of flat ground on one body. A treel drive has one row along each track, limited by the motor and by
/// friction under half the weight. A third row acts against lateral sliding, limited by friction under the whole
/// weight. For a body without a drive, friction against sliding and turning is coupled within an ellipsoid, the limit
/// surface of a sliding patch. Source: Howe and Cutkosky, "Practical force-motion models for sliding manipulation",
/// IJRR 1996.
class PlanarGround {
 public:
  /// Creates a ground without any force.
  PlanarGround() = default;
  /// Creates the ground under a drive whose link is at X_BL in the body; `weight` [N].
  PlanarGround(const description::TrackPair& drive, const Pose& X_BL, double friction, double weight,
               const PlanarInertia& inertia, double step);
  /// Creates the ground under a body that lies on a patch; the mean distance of the patch's points from the centre of
  /// mass is `arm` [m].
  PlanarGround(double friction, double weight, double arm, double step);

  void set_target(Side side, double velocity) { tracks_[static_cast<std::size_t>(side)].target = velocity; }
  const OutputState& track(Side side) const { return tracks_[static_cast<std::size_t>(side)].state; }
  const std::array<double, 3>& impulse() const { return impulse_; }
  void set_impulse(const std::array<double, 3>& impulse) { impulse_ = impulse; }

  /// Applies the impulses of the last step to the body.
  void begin(const PlanarPlace& place, const PlanarInertia& inertia, PlanarVelocity& velocity);
  /// Makes one pass over the rows. Returns the greatest change of a velocity [m/s].
  double solve(const PlanarInertia& inertia, PlanarVelocity& velocity);
  /// Stores the state of the tracks.
  void finish(const PlanarVelocity& velocity, double step);

  /// Calls `visit` for each number of the state, always in the same order.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit) {
    for (auto& impulse : self.impulse_) visit(impulse);
    if (!self.is_drive_) return;
    for (auto& track : self.tracks_) {
      visit(track.target);
      visit(track.state.position);
      visit(track.state.velocity);
      visit(track.state.effort);
    }
  }

 private:
  struct Track {
    double target = 0.0;
    OutputState state;
  };
  struct Row {
    double lever = 0.0;     // lever arm of the row's direction about the centre of mass [m]
    double mobility = 0.0;  // velocity change by a unit impulse [1/kg]
    double mass = 0.0;      // 1 / mobility, zero if immovable
    double limit = 0.0;     // [N s]
  };
  double solve_patch(const PlanarInertia& inertia, PlanarVelocity& velocity);
  /// Solves both tracks at once if neither reaches its limit; otherwise returns false.
  bool solve_tracks(const PlanarInertia& inertia, PlanarVelocity& velocity, double& change);
  double solve_row(std::size_t index, double target, const Eigen::Vector2d& direction_W, const PlanarInertia& inertia,
                   PlanarVelocity& velocity);

  bool is_drive_ = false;
  std::array<Row, 3> rows_;  // left, right, lateral; for a patch the limits along x, along y, about z
  double motor_limit_ = 0.0;
  double coupling_ = 0.0;             // velocity at one track by a unit impulse at the other [1/kg]
  double inverse_determinant_ = 0.0;  // for the equations of the two tracks
  Eigen::Vector2d forward_B_ = Eigen::Vector2d::UnitX();
  std::array<double, 3> impulse_{};  // by row
  std::array<Track, 2> tracks_;
  Eigen::Vector2d forward_W_ = Eigen::Vector2d::UnitX();  // in this step
};

}  // namespace cohort::physics
