// SPDX-License-Identifier: Apache-2.0
#include "server/physics/dynamics/integration.hpp"

#include <algorithm>
#include <array>

#include "server/physics/dynamics/whole_body.hpp"
#include "server/physics/mechanism/rotation.hpp"

namespace cohort::physics {
namespace {

struct Turn {
  Eigen::Quaterniond rotation;  // after the step
  Eigen::Vector3d angular_W;
};

// Rotates a free body; conserves its angular momentum exactly and its energy nearly. Half a step with the initial
// angular velocity gives the velocity in the middle, which turns the body over the whole step.
Turn turned_freely(const BodyMotion& body, double step) {
  const Eigen::Matrix3d& inertia_S = body.mechanism().segments()[0].inertia_S;
  const Eigen::Matrix3d inverse_S = inertia_S.inverse();
  const Eigen::Map<const Eigen::Vector3d> angular_W(body.velocities());
  const Eigen::Quaterniond before = body.state().root_rotation();
  const Eigen::Vector3d momentum_W = before * (inertia_S * (before.conjugate() * angular_W));
  const auto turned_by = [&](const Eigen::Vector3d& turn) { return (rotation_by(turn) * before).normalized(); };
  const auto velocity_at = [&](const Eigen::Quaterniond& rotation) -> Eigen::Vector3d {
    return rotation * (inverse_S * (rotation.conjugate() * momentum_W));
  };
  const Eigen::Vector3d middle_W = velocity_at(turned_by(0.5 * step * angular_W));
  const Eigen::Quaterniond after = turned_by(step * middle_W);
  return {after, velocity_at(after)};
}

Eigen::Quaterniond turned_root(const BodyMotion& body, double step) {
  const double* v = body.velocities();
  return (rotation_by(step * Eigen::Vector3d(v[0], v[1], v[2])) * body.state().root_rotation()).normalized();
}

Eigen::Vector3d moved_root(const BodyMotion& body, double step) {
  const double* v = body.velocities() + 3;
  return body.reference() + step * Eigen::Vector3d(v[0], v[1], v[2]);
}

void move_joints(BodyMotion& body, double step) {
  BodyState& state = body.state();
  for (const Segment& segment : body.mechanism().segments())
    move_joint(segment, state.velocities() + segment.first_dof, step, state.coordinates(segment.first_coordinate));
}

}  // namespace

void integrate(BodyMotion& body, const double* velocities, double step) {
  const Mechanism& mechanism = body.mechanism();
  BodyState& state = body.state();
  const int kept = mechanism.has_kinematic_root() ? mechanism.segments()[0].dofs : 0;
  std::copy_n(velocities + kept, mechanism.dof_count() - kept, state.velocities() + kept);
  move_joints(body, step);
  if (mechanism.has_free_root()) {
    if (mechanism.turns_freely()) {
      const Turn turn = turned_freely(body, step);
      state.set_root_rotation(turn.rotation);
      std::copy_n(turn.angular_W.data(), 3, state.velocities());
    } else {
      state.set_root_rotation(turned_root(body, step));
    }
    state.set_reference(moved_root(body, step));
  }
  body.update_poses();
}

Pose pose_ahead(const BodyMotion& body, int segment, double step) {
  const Mechanism& mechanism = body.mechanism();
  const Segment& its = mechanism.segments()[static_cast<std::size_t>(segment)];
  if (its.motion == Motion::free) {
    const Eigen::Quaterniond rotation =
        mechanism.turns_freely() ? turned_freely(body, step).rotation : turned_root(body, step);
    return {moved_root(body, step) - rotation * its.centre_S, rotation};
  }
  const Pose X_WP = its.parent < 0 ? body.model_pose() : pose_ahead(body, its.parent, step);
  std::array<double, 4> coordinates{};
  std::copy_n(body.state().coordinates(its.first_coordinate), zero_coordinates_of(its.motion).size(),
              coordinates.begin());
  move_joint(its, body.velocities() + its.first_dof, step, coordinates.data());
  return moved_by_joint(its, X_WP * its.X_PS, coordinates.data());
}

// Conserves the momentum of the whole body except for external impulses: the motion of the root follows from that of
// the joints. The angular velocity of the middle of the step turns the root, as in turned_freely. With the velocities
// that the equations predict from the beginning of a step, a spinning wheel would make its hull swing further and
// further.
void fly(BodyMotion& body, const double* velocities, const Eigen::Vector3d& impulse_W,
         const Eigen::Vector3d& angular_impulse_W, const Eigen::Vector3d& gravity, double step) {
  BodyState& state = body.state();
  double* const v = state.velocities();
  Eigen::Map<Eigen::Vector3d> angular_W(v);
  Eigen::Map<Eigen::Vector3d> linear_W(v + 3);
  const WholeBody before(body);
  const Eigen::Vector3d arm_W = before.centre_W - body.reference();
  const Eigen::Vector3d momentum_W =
      before.inertia_W * angular_W + before.joints_angular_momentum_W + angular_impulse_W - arm_W.cross(impulse_W);
  const Eigen::Vector3d velocity_W = linear_W + angular_W.cross(arm_W) + step * gravity +
                                     (before.joints_momentum_W + impulse_W) / before.mass;  // centre of mass

  std::copy_n(velocities, body.mechanism().dof_count(), v);
  const Eigen::Quaterniond rotation = state.root_rotation();
  const auto turn_by = [&](const Eigen::Vector3d& turn) {
    state.set_root_rotation((rotation_by(turn) * rotation).normalized());
    body.update_poses();
  };
  angular_W = WholeBody(body).angular_velocity_at(momentum_W);
  move_joints(body, 0.5 * step);
  turn_by(0.5 * step * angular_W);
  angular_W = WholeBody(body).angular_velocity_at(momentum_W);
  move_joints(body, 0.5 * step);
  turn_by(step * angular_W);
  const WholeBody after(body);
  angular_W = after.angular_velocity_at(momentum_W);
  linear_W = velocity_W - after.joints_momentum_W / after.mass - angular_W.cross(after.centre_W - body.reference());
  body.move(before.centre_W + step * velocity_W - after.centre_W);
}

}  // namespace cohort::physics
