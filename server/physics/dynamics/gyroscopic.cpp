#include "server/physics/dynamics/gyroscopic.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cohort::physics {
namespace {

using Eigen::Vector3d;

// Torques that turn something at this rate [rad/s], taken as they are at the beginning of steps, change its energy by
// the rate's square times the step in each second. Less than this is slow [1/s].
constexpr double slow = 0.2;
// The same of a ball joint of what nothing else touches or holds: nothing hides it there.
constexpr double slow_ball = 0.002;

bool is_fast(double rate, double step, double limit = slow) { return step * rate * rate > limit; }

// Whether it resists alike in all directions about its joint, and carries nothing: a caster.
bool is_round(const std::vector<Segment>& segments, std::size_t s) {
  constexpr double tolerance = 1e-6;
  const Segment& segment = segments[s];
  const Vector3d inertia = segment.inertia_S.diagonal();
  const double least = inertia.minCoeff();
  return inertia.maxCoeff() - least <= tolerance * least &&
         segment.mass * segment.centre_S.squaredNorm() <= tolerance * least &&
         std::ranges::none_of(segments, [&](const Segment& other) { return other.parent == static_cast<int>(s); });
}

// A ball joint's velocities turn with its segment, and seem to be turned by that; of what is round only as far as what
// carries it turns.
bool has_fast_ball(const BodyMotion& body, double step, bool is_held) {
  const std::vector<Segment>& segments = body.mechanism().segments();
  const double limit = is_held ? slow : slow_ball;
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

// No segment turns faster [rad/s].
double bound_of_turning(const BodyMotion& body) {
  double turn = 0.0;
  for (const Segment& segment : body.mechanism().segments()) {
    if (segment.motion == Motion::prismatic) continue;
    const int turning = std::min(segment.dofs, 3);  // of a free root the first three
    for (int i = segment.first_dof; i < segment.first_dof + turning; ++i) turn += std::abs(body.velocities()[i]);
  }
  return turn;
}

}  // namespace

// Of each joint what spins beyond it, against its own segment and across its axis, by what the segment resists with.
bool has_stiff_gyroscopic_torques(const BodyMotion& body, double step, bool is_held) {
  // How a body on its own turns is left to `integrate`. What closes a loop wants all rows solved at once, and for that
  // symmetric equations.
  const bool has_loops = !body.mechanism().model().loop_joints.empty();
  if (body.mechanism().is_free_body() || has_loops) return false;
  if (has_fast_ball(body, step, is_held)) return true;
  if (!is_fast(bound_of_turning(body), step)) return false;
  const std::vector<Segment>& segments = body.mechanism().segments();
  struct Turning {
    Vector3d angular_W;
    Eigen::Matrix3d inertia_W;    // of all beyond, each about its own centre
    Vector3d angular_momentum_W;  // likewise
  };
  std::vector<Turning> turning(segments.size());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Pose& X_WS = body.segment_poses()[s];
    const Eigen::Matrix3d R = X_WS.orientation.toRotationMatrix();
    turning[s].angular_W = body.segment_twist(static_cast<int>(s), X_WS.position).angular_W;
    turning[s].inertia_W = R * segments[s].inertia_S * R.transpose();
    turning[s].angular_momentum_W = turning[s].inertia_W * turning[s].angular_W;
  }
  for (std::size_t s = segments.size(); s-- > 0;) {
    const Segment& segment = segments[s];
    if (segment.motion != Motion::prismatic && segment.motion != Motion::anchored) {
      const Vector3d spin_W = turning[s].angular_momentum_W - turning[s].inertia_W * turning[s].angular_W;
      const Vector3d axis_W = body.segment_poses()[s].orientation * segment.axis_S;
      const double across = segment.motion == Motion::revolute ? axis_W.cross(spin_W).norm() : spin_W.norm();
      if (is_fast(across / segment.inertia_S.diagonal().minCoeff(), step)) return true;
    }
    if (segment.parent < 0) continue;
    turning[at(segment.parent)].inertia_W += turning[s].inertia_W;
    turning[at(segment.parent)].angular_momentum_W += turning[s].angular_momentum_W;
  }
  return false;
}

}  // namespace cohort::physics
