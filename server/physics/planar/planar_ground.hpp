#pragma once

#include <array>

#include "server/physics/planar/planar_bodies.hpp"

namespace cohort::physics {

/// What the flat ground does to one body. A treel drive has two rows along its tracks, each limited by the motor and by
/// friction under half the weight, and one against sliding sideways, limited by friction under the whole. A body
/// without a drive has friction against sliding and turning together, within an ellipsoid: the limit surface of a patch
/// that slides (Howe and Cutkosky, "Practical force-motion models for sliding manipulation", IJRR 1996).
class PlanarGround {
 public:
  /// Nothing acts.
  PlanarGround() = default;
  /// A drive whose link has X_BL in the body; `weight` [N].
  PlanarGround(const description::TrackPair& drive, const Pose& X_BL, double friction, double weight,
               const PlanarInertia& inertia, double step);
  /// A body that lies on a patch whose points are at the mean distance `arm` from its centre of mass [m].
  PlanarGround(double friction, double weight, double arm, double step);

  void set_target(Side side, double velocity) { tracks_[static_cast<std::size_t>(side)].target = velocity; }
  const OutputState& track(Side side) const { return tracks_[static_cast<std::size_t>(side)].state; }
  const std::array<double, 3>& impulse() const { return impulse_; }
  void set_impulse(const std::array<double, 3>& impulse) { impulse_ = impulse; }

  /// Puts the impulses of the last step on the body.
  void begin(const PlanarPlace& place, const PlanarInertia& inertia, PlanarVelocity& velocity);
  /// One pass over the rows. Returns by how much it changed the velocity at the most [m/s].
  double solve(const PlanarInertia& inertia, PlanarVelocity& velocity);
  /// Takes over what the tracks do.
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
    double lever = 0.0;     // of the row's direction about the centre of mass [m]
    double mobility = 0.0;  // velocity that a unit of impulse gives [1/kg]
    double mass = 0.0;      // its inverse, zero of what cannot move
    double limit = 0.0;     // [N s]
  };
  double solve_patch(const PlanarInertia& inertia, PlanarVelocity& velocity);
  /// Both tracks at once, where neither comes to its limit. False if one would.
  bool solve_tracks(const PlanarInertia& inertia, PlanarVelocity& velocity, double& change);
  double solve_row(std::size_t index, double target, const Eigen::Vector2d& direction_W, const PlanarInertia& inertia,
                   PlanarVelocity& velocity);

  bool is_drive_ = false;
  std::array<Row, 3> rows_;  // left, right, sideways; of a patch the limits along x, along y, about z
  double motor_limit_ = 0.0;
  double coupling_ = 0.0;             // velocity that the impulse of one track gives at the other [1/kg]
  double inverse_determinant_ = 0.0;  // of the two tracks' equations
  Eigen::Vector2d forward_B_ = Eigen::Vector2d::UnitX();
  std::array<double, 3> impulse_{};  // of the rows
  std::array<Track, 2> tracks_;
  Eigen::Vector2d forward_W_ = Eigen::Vector2d::UnitX();  // of this step
};

}  // namespace cohort::physics
