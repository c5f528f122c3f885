#include "server/physics/dynamics/integration.hpp"

#include <algorithm>

#include "server/physics/dynamics/whole_body.hpp"
#include "server/physics/mechanism/rotation.hpp"

namespace cohort::physics {
namespace {

// Rotates a free body; conserves its angular momentum exactly and its energy nearly. Half a step with the initial
// angular velocity gives the velocity in the middle, which turns the body over the whole step.
void turn_freely(BodyMotion& body, double step) {
  BodyState& state = body.state();
  const Eigen::Matrix3d& inertia_S = body.mechanism().segments()[0].inertia_S;
  const Eigen::Matrix3d inverse_S = inertia_S.inverse();
  const Eigen::Map<const Eigen::Vector3d> angular_W(state.velocities());
  const Eigen::Quaterniond before = state.root_rotation();
  const Eigen::Vector3d momentum_W = before * (inertia_S * (before.conjugate() * angular_W));
  const auto turned_by = [&](const Eigen::Vector3d& turn) { return (rotation_by(turn) * before).normalized(); };
  const auto velocity_at = [&](const Eigen::Quaterniond& rotation) -> Eigen::Vector3d {
    return rotation * (inverse_S * (rotation.conjugate() * momentum_W));
  };
  const Eigen::Vector3d middle_W = velocity_at(turned_by(0.5 * step * angular_W));
  const Eigen::Quaterniond after = turned_by(step * middle_W);
  const Eigen::Vector3d new_angular_W = velocity_at(after);
  state.set_root_rotation(after);
  std::copy_n(new_angular_W.data(), 3, state.velocities());
}

void move_joints(BodyMotion& body, double step) {
  for (const Segment& segment : body.mechanism().segments()) {
    const double* v = body.state().velocities() + segment.first_dof;
    double* coordinates = body.state().coordinates(segment.first_coordinate);
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
}

}  // namespace

void integrate(BodyMotion& body, const double* velocities, double step) {
  const Mechanism& mechanism = body.mechanism();
  BodyState& state = body.state();
  const int kept = mechanism.has_kinematic_root() ? mechanism.segments()[0].dofs : 0;
  std::copy_n(velocities + kept, mechanism.dof_count() - kept, state.velocities() + kept);
  move_joints(body, step);
  if (mechanism.has_free_root()) {
    const double* v = state.velocities();
    if (mechanism.turns_freely()) {
      turn_freely(body, step);
    } else {
      const Eigen::Quaterniond turn = rotation_by(step * Eigen::Vector3d(v[0], v[1], v[2]));
      state.set_root_rotation((turn * state.root_rotation()).normalized());
    }
    state.set_reference(state.reference() + step * Eigen::Vector3d(v[3], v[4], v[5]));
  }
  body.update_poses();
}

// Conserves the momentum of the whole body except for external impulses: the motion of the root follows from that of
// the joints. The angular velocity of the middle of the step turns the root, as in turn_freely. With the velocities
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
