#include "server/physics/multibody/multibody.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "server/physics/mechanism/rotation.hpp"
#include "server/physics/multibody/whole_body.hpp"

namespace cohort::physics {
namespace {

Eigen::Quaterniond ball_rotation(const double* coordinates) {
  return {coordinates[3], coordinates[0], coordinates[1], coordinates[2]};
}

}  // namespace

Multibody::Multibody(const Mechanism& mechanism, description::Dynamics dynamics, const Pose& X_WM, BodyId body)
    : mechanism_(&mechanism),
      body_(body),
      bullet_(dynamics == description::Dynamics::bullet ? std::make_unique<BulletBody>(mechanism) : nullptr),
      state_(bullet_ ? BodyState(mechanism, bullet_->memory()) : BodyState(mechanism)),
      X_WS_(mechanism.segments().size()),
      joints_(mechanism),
      loops_(mechanism),
      belts_(mechanism) {
  place(X_WM);
  build_devices();
}

void Multibody::build_devices() {
  const description::Model& model = mechanism_->model();
  drives_.resize(model.devices.size());
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    for (const description::MotorLimits& motor : description::motor_limits(model.devices[device])) {
      const std::string& name = description::name_of(model.devices[device]);
      if (mechanism_->joint(motor.joint).dofs == 0)
        throw std::invalid_argument("motor '" + name + "' drives the fixed joint '" + model.joints[motor.joint].name +
                                    "'");
      add_motor(mechanism_->joint(motor.joint).first_dof, motor.max_effort, motor.max_velocity, name);
    }
    if (const auto drive = description::tracks_of(model.devices[device])) add_drive(device, *drive);
  }
}

void Multibody::add_motor(int dof, double max_effort, double max_velocity, const std::string& device) {
  if (joints_.has_motor(dof))
    throw std::invalid_argument("motor '" + device + "' drives a joint that has a motor already");
  joints_.add_motor(dof, max_effort, max_velocity);
}

void Multibody::add_drive(std::size_t device, const description::TrackPair& drive) {
  const description::Model& model = mechanism_->model();
  const std::string& name = description::name_of(model.devices[device]);
  if (mechanism_->link(drive.link).segment != 0)
    throw std::invalid_argument("treel drive '" + name + "' is not on the root link '" + model.links[0].name + "'");
  if (!mechanism_->has_wheels() || (drive.left_wheels.empty() && drive.right_wheels.empty())) {
    drives_[device].treel = static_cast<int>(treels_.size());
    treels_.emplace_back(model, drive, mechanism_->link(drive.link).X_SL);
    return;
  }
  drives_[device].wheels = static_cast<int>(wheels_.size());
  WheelDrive& wheels = wheels_.emplace_back();
  wheels.radius = drive.wheel_radius;
  for (const Side side : {Side::left, Side::right}) {
    const auto s = static_cast<std::size_t>(side);
    const std::vector<std::size_t>& joints = side == Side::left ? drive.left_wheels : drive.right_wheels;
    for (const std::size_t joint : joints) {
      const Mechanism::JointPlace& place = mechanism_->joint(joint);
      const Segment& wheel = mechanism_->segments()[static_cast<std::size_t>(place.segment)];
      const Eigen::Vector3d axis = wheel.X_PS.orientation * wheel.axis_S;
      add_motor(place.first_dof, drive.max_torque / static_cast<double>(joints.size()),
                drive.max_velocity / drive.wheel_radius, name);
      wheels.dofs[s].push_back(place.first_dof);
      wheels.senses[s].push_back(axis.y() < 0.0 ? -1.0 : 1.0);
    }
  }
}

void Multibody::update_poses() {
  for (std::size_t s = 0; s < X_WS_.size(); ++s) {
    const Segment& segment = mechanism_->segments()[s];
    if (segment.motion == Motion::free) {
      const Eigen::Quaterniond rotation = state_.root_rotation();
      X_WS_[s] = {reference() - rotation * segment.centre_S, rotation};
      continue;
    }
    const Pose& X_WP = segment.parent < 0 ? X_WM_ : X_WS_[static_cast<std::size_t>(segment.parent)];
    X_WS_[s] = moved_by_joint(segment, X_WP * segment.X_PS, state_.coordinates(segment.first_coordinate));
  }
  if (!mechanism_->has_free_root()) state_.set_reference(X_WS_[0].position);
}

Pose Multibody::link_pose(std::size_t link) const {
  const Mechanism::LinkPlace& place = mechanism_->link(link);
  return segment_pose(place.segment) * place.X_SL;
}

Twist Multibody::link_twist(std::size_t link) const {
  return segment_twist(mechanism_->link(link).segment, link_pose(link).position);
}

Twist Multibody::segment_twist(int of_segment, const Eigen::Vector3d& point_W) const {
  Twist twist{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  // From the segment to the root: each joint adds what it does to the point.
  for (int s = of_segment; s >= 0; s = mechanism_->segments()[static_cast<std::size_t>(s)].parent) {
    const Segment& segment = mechanism_->segments()[static_cast<std::size_t>(s)];
    const Pose& X_WS = segment_pose(s);
    const double* v = velocities() + segment.first_dof;
    Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d pivot_W = X_WS.position;
    switch (segment.motion) {
      case Motion::anchored: break;
      case Motion::free:
        angular_W = {v[0], v[1], v[2]};
        pivot_W = reference();
        twist.linear_W += Eigen::Vector3d(v[3], v[4], v[5]);
        break;
      case Motion::revolute: angular_W = v[0] * (X_WS.orientation * segment.axis_S); break;
      case Motion::prismatic: twist.linear_W += v[0] * (X_WS.orientation * segment.axis_S); break;
      case Motion::ball: angular_W = X_WS.orientation * Eigen::Vector3d(v[0], v[1], v[2]); break;
    }
    twist.angular_W += angular_W;
    twist.linear_W += angular_W.cross(point_W - pivot_W);
  }
  return twist;
}

double Multibody::greatest_speed(double reach) const {
  double sum = 0.0;
  for (const Segment& segment : mechanism_->segments()) {
    const double* v = velocities() + segment.first_dof;
    const auto length = [&](int i) { return std::abs(v[i]) + std::abs(v[i + 1]) + std::abs(v[i + 2]); };
    switch (segment.motion) {
      case Motion::anchored: break;
      case Motion::free: sum += reach * length(0) + length(3); break;
      case Motion::revolute: sum += reach * std::abs(v[0]); break;
      case Motion::prismatic: sum += std::abs(v[0]); break;
      case Motion::ball: sum += reach * length(0); break;
    }
  }
  return sum;
}

double Multibody::joint_position(std::size_t joint) const {
  const Mechanism::JointPlace& place = mechanism_->joint(joint);
  return place.dofs == 0 ? 0.0 : *state_.coordinates(place.first_coordinate);
}

double Multibody::joint_velocity(std::size_t joint) const {
  const Mechanism::JointPlace& place = mechanism_->joint(joint);
  return place.dofs == 0 ? 0.0 : velocities()[place.first_dof];
}

void Multibody::place(const Pose& X_WM) {
  const Segment& root = mechanism_->segments()[0];
  const Pose X_WS = X_WM * root.X_PS;
  X_WM_ = X_WM;
  state_.set_root_rotation(X_WS.orientation);
  state_.set_reference(mechanism_->has_free_root() ? X_WS * root.centre_S : X_WS.position);
  stop();
  update_poses();
}

void Multibody::set_root_twist(const Twist& twist) {
  const Eigen::Vector3d to_reference_W = reference() - link_pose(0).position;
  const Eigen::Vector3d linear_W = twist.linear_W + twist.angular_W.cross(to_reference_W);
  std::copy_n(twist.angular_W.data(), 3, state_.velocities());
  std::copy_n(linear_W.data(), 3, state_.velocities() + 3);
}

void Multibody::set_joint_state(std::size_t joint, std::span<const double> coordinates,
                                std::span<const double> velocities) {
  const Mechanism::JointPlace& place = mechanism_->joint(joint);
  double* const v = state_.velocities() + place.first_dof;
  std::copy(velocities.begin(), velocities.end(), v);
  constexpr int dofs_of_ball = 3;
  if (place.dofs == dofs_of_ball) {
    const Eigen::Quaterniond& axes = mechanism_->segments()[static_cast<std::size_t>(place.segment)].principal_axes;
    const Eigen::Quaterniond to_axes = axes.conjugate();
    const Eigen::Quaterniond rotation = to_axes * ball_rotation(coordinates.data()) * axes;
    std::copy_n(rotation.coeffs().data(), 4, state_.coordinates(place.first_coordinate));
    const Eigen::Vector3d turned = to_axes * Eigen::Vector3d(v[0], v[1], v[2]);
    std::copy_n(turned.data(), 3, v);
  } else {
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      *state_.coordinates(place.first_coordinate + static_cast<int>(i)) = coordinates[i];
  }
  for (const auto& [dof, leader, multiplier, offset] : mechanism_->followers()) {
    if (leader != place.first_dof) continue;
    const int coordinate = mechanism_->dofs()[static_cast<std::size_t>(leader)].coordinate;
    *state_.coordinates(mechanism_->dofs()[static_cast<std::size_t>(dof)].coordinate) =
        multiplier * *state_.coordinates(coordinate) + offset;
    state_.velocities()[dof] = multiplier * state_.velocities()[leader];
  }
  update_poses();
}

bool Multibody::set_joint_target(std::size_t joint, JointRows::Control control, double target) {
  return joints_.set_target(mechanism_->joint(joint).first_dof, control, target);
}

double Multibody::joint_effort(std::size_t joint) const {
  const Mechanism::JointPlace& place = mechanism_->joint(joint);
  if (place.dofs == 0 || !joints_.has_motor(place.first_dof) || last_step_ == 0.0) return 0.0;
  return joints_.motor_impulse(place.first_dof) / last_step_;
}

double Multibody::driven_power() const {
  double power = 0.0;
  for (const std::size_t joint : mechanism_->motor_joints())
    power += std::max(0.0, joint_effort(joint) * joint_velocity(joint));
  for (std::size_t device = 0; device < drives_.size(); ++device) {
    if (drives_[device].treel < 0 && drives_[device].wheels < 0) continue;
    for (const Side side : {Side::left, Side::right}) {
      const TrackState state = track(device, side);
      power += std::max(0.0, state.traction * state.velocity);
    }
  }
  return power + belts_.power();
}

bool Multibody::set_track_velocity_target(std::size_t device, Side side, double velocity) {
  const Drive& drive = drives_[device];
  if (drive.treel >= 0) return treels_[static_cast<std::size_t>(drive.treel)].set_target(side, velocity);
  const WheelDrive& wheels = wheels_[static_cast<std::size_t>(drive.wheels)];
  const auto s = static_cast<std::size_t>(side);
  bool is_new = false;
  for (std::size_t i = 0; i < wheels.dofs[s].size(); ++i)
    is_new |= joints_.set_target(wheels.dofs[s][i], JointRows::Control::velocity,
                                 wheels.senses[s][i] * velocity / wheels.radius);
  return is_new;
}

TrackState Multibody::track(std::size_t device, Side side) const {
  const Drive& drive = drives_[device];
  if (drive.treel >= 0) return treels_[static_cast<std::size_t>(drive.treel)].track(side);
  // Wheels of one side turn alike but for slip: their mean.
  const WheelDrive& wheels = wheels_[static_cast<std::size_t>(drive.wheels)];
  const auto s = static_cast<std::size_t>(side);
  TrackState state;
  for (std::size_t i = 0; i < wheels.dofs[s].size(); ++i) {
    const int dof = wheels.dofs[s][i];
    const double sense = wheels.senses[s][i];
    state.position += sense * coordinate(mechanism_->dofs()[static_cast<std::size_t>(dof)]) * wheels.radius;
    state.velocity += sense * velocities()[dof] * wheels.radius;
    if (last_step_ > 0.0) state.traction += sense * joints_.motor_impulse(dof) / last_step_ / wheels.radius;
  }
  if (const auto count = static_cast<double>(wheels.dofs[s].size()); count > 0.0) {
    state.position /= count;
    state.velocity /= count;
  }
  return state;
}

void Multibody::add_rows(Problem& problem, int index, const Anchors& anchors, double step) {
  joints_.add_rows(problem, index, *this, step);
  loops_.add_rows(problem, index, *this, step);
  for (TrackRows& treel : treels_) treel.add_rows(problem, index, anchors, step);
}

// Keeps the angular momentum as it is while the body turns, and its energy nearly: half a step with the angular
// velocity at its beginning, then all of it with that of the middle.
void Multibody::turn_freely(double step) {
  const Eigen::Matrix3d& inertia_S = mechanism_->segments()[0].inertia_S;
  const Eigen::Matrix3d inverse_S = inertia_S.inverse();
  const Eigen::Map<const Eigen::Vector3d> angular_W(velocities());
  const Eigen::Quaterniond before = state_.root_rotation();
  const Eigen::Vector3d momentum_W = before * (inertia_S * (before.conjugate() * angular_W));
  const auto turned_by = [&](const Eigen::Vector3d& turn) { return (rotation_by(turn) * before).normalized(); };
  const auto velocity_at = [&](const Eigen::Quaterniond& rotation) -> Eigen::Vector3d {
    return rotation * (inverse_S * (rotation.conjugate() * momentum_W));
  };
  const Eigen::Vector3d middle_W = velocity_at(turned_by(0.5 * step * angular_W));
  const Eigen::Quaterniond after = turned_by(step * middle_W);
  const Eigen::Vector3d new_angular_W = velocity_at(after);
  state_.set_root_rotation(after);
  std::copy_n(new_angular_W.data(), 3, state_.velocities());
}

void Multibody::move_joints(double step) {
  for (const Segment& segment : mechanism_->segments()) {
    const double* v = state_.velocities() + segment.first_dof;
    double* coordinates = state_.coordinates(segment.first_coordinate);
    switch (segment.motion) {
      case Motion::anchored:
      case Motion::free: break;
      case Motion::revolute:
      case Motion::prismatic: coordinates[0] += step * v[0]; break;
      case Motion::ball: {
        const Eigen::Quaterniond turned =
            (ball_rotation(coordinates) * rotation_by(step * Eigen::Vector3d(v[0], v[1], v[2]))).normalized();
        for (int i = 0; i < 4; ++i) coordinates[i] = turned.coeffs()[i];  // x y z w
        break;
      }
    }
  }
}

void Multibody::integrate(const double* velocities, double step) {
  const int kept = mechanism_->has_kinematic_root() ? mechanism_->segments()[0].dofs : 0;
  std::copy_n(velocities + kept, mechanism_->dof_count() - kept, state_.velocities() + kept);
  last_step_ = step;
  move_joints(step);
  if (mechanism_->has_free_root()) {
    const double* v = state_.velocities();
    if (mechanism_->is_free_body()) {
      turn_freely(step);
    } else {
      const Eigen::Quaterniond turn = rotation_by(step * Eigen::Vector3d(v[0], v[1], v[2]));
      state_.set_root_rotation((turn * state_.root_rotation()).normalized());
    }
    state_.set_reference(reference() + step * Eigen::Vector3d(v[3], v[4], v[5]));
  }
  update_poses();
}

// Keeps the momentum of the whole body as it is but for what comes from outside: the root turns and moves as the joints
// leave it to. The angular velocity of the middle of the step turns it, as in turn_freely. With the velocities that the
// equations foresee from the beginning of a step, a wheel that spins would make its hull swing further and further.
void Multibody::fly(const double* velocities, const Eigen::Vector3d& impulse_W,
                    const Eigen::Vector3d& angular_impulse_W, const Eigen::Vector3d& gravity, double step) {
  double* const v = state_.velocities();
  Eigen::Map<Eigen::Vector3d> angular_W(v);
  Eigen::Map<Eigen::Vector3d> linear_W(v + 3);
  const WholeBody before(*this);
  const Eigen::Vector3d arm_W = before.centre_W - reference();
  const Eigen::Vector3d momentum_W =
      before.inertia_W * angular_W + before.joints_angular_momentum_W + angular_impulse_W - arm_W.cross(impulse_W);
  const Eigen::Vector3d velocity_W = linear_W + angular_W.cross(arm_W) + step * gravity +
                                     (before.joints_momentum_W + impulse_W) / before.mass;  // of the centre

  std::copy_n(velocities, mechanism_->dof_count(), v);
  last_step_ = step;
  const Eigen::Quaterniond rotation = state_.root_rotation();
  const auto turn_by = [&](const Eigen::Vector3d& turn) {
    state_.set_root_rotation((rotation_by(turn) * rotation).normalized());
    update_poses();
  };
  angular_W = WholeBody(*this).angular_velocity_at(momentum_W);
  move_joints(0.5 * step);
  turn_by(0.5 * step * angular_W);
  angular_W = WholeBody(*this).angular_velocity_at(momentum_W);
  move_joints(0.5 * step);
  turn_by(step * angular_W);
  const WholeBody after(*this);
  angular_W = after.angular_velocity_at(momentum_W);
  linear_W = velocity_W - after.joints_momentum_W / after.mass - angular_W.cross(after.centre_W - reference());
  move(before.centre_W + step * velocity_W - after.centre_W);
}

}  // namespace cohort::physics
