#include "server/physics/multibody/multibody.hpp"

#include <algorithm>
#include <stdexcept>

namespace cohort::physics {

Multibody::Multibody(const Mechanism& mechanism, description::Dynamics dynamics, const Pose& X_WM, BodyId body)
    : motion_(mechanism, dynamics, X_WM), body_(body), joints_(mechanism), loops_(mechanism), belts_(mechanism) {
  build_devices();
}

void Multibody::build_devices() {
  const description::Model& model = mechanism().model();
  drives_.resize(model.devices.size());
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    for (const description::MotorLimits& motor : description::motor_limits(model.devices[device])) {
      const std::string& name = description::name_of(model.devices[device]);
      if (mechanism().joint(motor.joint).dofs == 0)
        throw std::invalid_argument("motor '" + name + "' drives the fixed joint '" + model.joints[motor.joint].name +
                                    "'");
      add_motor(mechanism().joint(motor.joint).first_dof, motor.max_effort, motor.max_velocity, name);
    }
    if (const description::TrackPair* const drive = description::tracks_of(model.devices[device]))
      add_drive(device, *drive);
  }
}

void Multibody::add_motor(int dof, double max_effort, double max_velocity, const std::string& device) {
  if (joints_.has_motor(dof))
    throw std::invalid_argument("motor '" + device + "' drives a joint that has a motor already");
  joints_.add_motor(dof, max_effort, max_velocity);
}

void Multibody::add_drive(std::size_t device, const description::TrackPair& drive) {
  const description::Model& model = mechanism().model();
  const std::string& name = description::name_of(model.devices[device]);
  if (mechanism().link(drive.link).segment != 0)
    throw std::invalid_argument("treel drive '" + name + "' is not on the root link '" + model.links[0].name + "'");
  if (!mechanism().has_wheels() || (drive.left_wheels.empty() && drive.right_wheels.empty())) {
    drives_[device].treel = static_cast<int>(treels_.size());
    treels_.emplace_back(model, drive, mechanism().link(drive.link).X_SL);
    return;
  }
  drives_[device].wheels = static_cast<int>(wheels_.size());
  WheelDrive& wheels = wheels_.emplace_back();
  wheels.radius = drive.wheel_radius;
  for (const Side side : {Side::left, Side::right}) {
    const auto s = static_cast<std::size_t>(side);
    const std::vector<std::size_t>& joints = side == Side::left ? drive.left_wheels : drive.right_wheels;
    for (const std::size_t joint : joints) {
      const Mechanism::JointPlace& place = mechanism().joint(joint);
      const Segment& wheel = mechanism().segments()[static_cast<std::size_t>(place.segment)];
      const Eigen::Vector3d axis = wheel.X_PS.orientation * wheel.axis_S;
      add_motor(place.first_dof, drive.max_torque / static_cast<double>(joints.size()),
                drive.max_velocity / drive.wheel_radius, name);
      wheels.dofs[s].push_back(place.first_dof);
      wheels.senses[s].push_back(axis.y() < 0.0 ? -1.0 : 1.0);
    }
  }
}

bool Multibody::set_joint_target(std::size_t joint, JointRows::Control control, double target) {
  return joints_.set_target(mechanism().joint(joint).first_dof, control, target);
}

double Multibody::joint_effort(std::size_t joint) const {
  const Mechanism::JointPlace& place = mechanism().joint(joint);
  if (place.dofs == 0 || !joints_.has_motor(place.first_dof) || last_step_ == 0.0) return 0.0;
  return joints_.motor_impulse(place.first_dof) / last_step_;
}

double Multibody::driven_power() const {
  double power = 0.0;
  for (const std::size_t joint : mechanism().motor_joints())
    power += std::max(0.0, joint_effort(joint) * motion_.joint_velocity(joint));
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
    state.position += sense * motion_.coordinate(mechanism().dofs()[static_cast<std::size_t>(dof)]) * wheels.radius;
    state.velocity += sense * motion_.velocities()[dof] * wheels.radius;
    if (last_step_ > 0.0) state.traction += sense * joints_.motor_impulse(dof) / last_step_ / wheels.radius;
  }
  if (const auto count = static_cast<double>(wheels.dofs[s].size()); count > 0.0) {
    state.position /= count;
    state.velocity /= count;
  }
  return state;
}

void Multibody::add_rows(Problem& problem, int index, const Anchors& anchors, double step) {
  joints_.add_rows(problem, index, motion_, step);
  loops_.add_rows(problem, index, motion_, step);
  for (TrackRows& treel : treels_) treel.add_rows(problem, index, anchors, step);
}

}  // namespace cohort::physics
