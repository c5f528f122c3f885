// SPDX-License-Identifier: Apache-2.0
#include "server/physics/dynamics/gyroscopic.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cohort::physics {
namespace {

using Eigen::Vector3d;

// Torques that precess a part at `rate` [rad/s], evaluated at the beginning of each step, change its energy by the
// factor rate^2 * step per second. A factor below this counts as slow [1/s].
constexpr double slow = 0.2;
// The same limit for a body that nothing else touches or holds: no friction hides the error there.
constexpr double slow_if_free = 0.002;

bool is_fast(double rate, double step, double limit = slow) { return step * rate * rate > limit; }

// Returns whether the segment has the same inertia about every axis through its joint and carries no other segment,
// like a caster.
bool is_round(const std::vector<Segment>& segments, std::size_t s) {
  constexpr double tolerance = 1e-6;
  const Segment& segment = segments[s];
  const Vector3d inertia = segment.inertia_S.diagonal();
  const double least = inertia.minCoeff();
  return inertia.maxCoeff() - least <= tolerance * least &&
         segment.mass * segment.centre_S.squaredNorm() <= tolerance * least &&
         std::ranges::none_of(segments, [&](const Segment& other) { return other.parent == static_cast<int>(s); });
}

// Returns whether a ball joint turns too fast. Its velocities are in axes of its segment and seem to turn with that;
// for a round segment only the rotation of its parent counts.
bool has_fast_ball(const BodyMotion& body, double step, bool is_held) {
  const std::vector<Segment>& segments = body.mechanism().segments();
  const double limit = is_held ? slow : slow_if_free;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Segment& segment = segments[s];
    if (segment.motion != Motion::ball) continue;
    const double* v = body.velocities() + segment.first_dof;
    if (!is_fast(Vector3d(v[0], v[1], v[2]).norm(), step, limit)) continue;
    if (!is_round(segments, s)) return true;
    if (segment.parent < 0) continue;
    const Vector3d& position_W = body.segment_poses()[s].position;
    if (is_fast(body.segment_twist(segment.parent, position_W).angular_W.norm(), step, limit)) return true;
  }
  return false;
}

// Returns whether a hinge turns too fast in a mechanism that swings freely. Its centrifugal forces turn other joints.
bool has_fast_hinge(const BodyMotion& body, double step, bool is_held) {
  if (is_held || !body.mechanism().swings_freely()) return false;
  return std::ranges::any_of(body.mechanism().segments(), [&](const Segment& segment) {
    return segment.motion == Motion::revolute && is_fast(body.velocities()[segment.first_dof], step, slow_if_free);
  });
}

// Returns whether the fluid turns a part too fast. The linear momentum of its added mass is not along its velocity,
// which turns the part (Munk, "The aerodynamic forces on airship hulls", NACA report 184, 1924).
bool has_fast_fluid(const BodyMotion& body, double step) {
  const Mechanism& mechanism = body.mechanism();
  for (std::size_t s = 0; s < mechanism.added_masses().size(); ++s) {
    const Pose& X_WS = body.segment_poses()[s];
    const Twist twist = body.segment_twist(static_cast<int>(s), X_WS.position);
    const Eigen::Quaterniond to_S = X_WS.orientation.conjugate();
    const Vector3d linear_S = to_S * twist.linear_W;
    const SpatialMatrix& added_mass = mechanism.added_masses()[s];
    const Vector3d momentum_S = added_mass.bottomRightCorner<3, 3>() * linear_S;
    const double inertia = mechanism.segments()[s].inertia_S.diagonal().minCoeff() +
                           std::max(0.0, added_mass.diagonal().head<3>().minCoeff());
    if (is_fast(twist.angular_W.norm() + std::sqrt(linear_S.norm() * momentum_S.norm() / inertia), step)) return true;
  }
  return false;
}

// Returns an upper bound on the angular speed of every segment [rad/s].
double bound_of_turning(const BodyMotion& body) {
  double turn = 0.0;
  for (const Segment& segment : body.mechanism().segments()) {
    const int turning = turning_dofs_of(segment.motion);
    for (int i = segment.first_dof; i < segment.first_dof + turning; ++i) turn += std::abs(body.velocities()[i]);
  }
  return turn;
}

}  // namespace

// Compares, for each joint, the angular momentum of the parts beyond it with the inertia that resists its turning. Only
// momentum relative to the segment and perpendicular to the joint's axis counts. The least inertia of the segment alone
// is a lower bound for the inertia, and mostly suffices.
bool has_stiff_gyroscopic_torques(const BodyMotion& body, double step, bool is_held, const FactorisedMass& mass) {
  // `integrate` handles the rotation of a free rigid body. A loop joint needs all rows solved at once, and for that
  // symmetric equations.
  const bool has_loops = !body.mechanism().model().loop_joints.empty();
  if (has_loops) return false;
  if (has_fast_fluid(body, step)) return true;
  if (body.mechanism().is_free_body()) return false;
  if (has_fast_ball(body, step, is_held) || has_fast_hinge(body, step, is_held)) return true;
  if (!is_fast(bound_of_turning(body), step)) return false;
  const std::vector<Segment>& segments = body.mechanism().segments();
  struct Turning {
    Vector3d angular_W;
    Eigen::Matrix3d inertia_W;    // sum over the segments beyond, each about its own centre
    Vector3d angular_momentum_W;  // the same sum
  };
  std::vector<Turning> turning(segments.size());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Pose& X_WS = body.segment_poses()[s];
    const Eigen::Matrix3d R = X_WS.orientation.toRotationMatrix();
    turning[s].angular_W = motion_at_joint(segments[s], R, body.velocities() + segments[s].first_dof).angular;
    if (segments[s].parent >= 0) turning[s].angular_W += turning[at(segments[s].parent)].angular_W;
    turning[s].inertia_W = R * segments[s].inertia_S * R.transpose();
    turning[s].angular_momentum_W = turning[s].inertia_W * turning[s].angular_W;
  }
  for (std::size_t s = segments.size(); s-- > 0;) {
    const Segment& segment = segments[s];
    if (turning_dofs_of(segment.motion) > 0) {
      const Vector3d spin_W = turning[s].angular_momentum_W - turning[s].inertia_W * turning[s].angular_W;
      const Vector3d axis_W = body.segment_poses()[s].orientation * segment.axis_S;
      const bool is_hinge = segment.motion == Motion::revolute;
      const double across = is_hinge ? axis_W.cross(spin_W).norm() : spin_W.norm();
      if (is_fast(across / segment.inertia_S.diagonal().minCoeff(), step) &&
          (!is_hinge || is_fast(across / mass().articulated_inertia(segment.first_dof), step)))
        return true;
    }
    if (segment.parent < 0) continue;
    turning[at(segment.parent)].inertia_W += turning[s].inertia_W;
    turning[at(segment.parent)].angular_momentum_W += turning[s].angular_momentum_W;
  }
  return false;
}

}  // namespace cohort::physics
