// SPDX-License-Identifier: Apache-2.0
#include "server/physics/multibody/multibody.hpp"

#include <stdexcept>

namespace cohort::physics {

Multibody::Multibody(const Mechanism& mechanism, description::Dynamics dynamics, const Pose& X_WM, BodyId body)
    : motion_(mechanism, dynamics, X_WM), body_(body), joints_(mechanism), loops_(mechanism), belts_(mechanism) {
  build_devices();
}

void Multibody::build_devices() {
  const description::Model& model = mechanism().model();
  const DeviceOutputs& outputs = mechanism().outputs();
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    const std::string& name = description::name_of(model.devices[device]);
    for (const description::MotorLimits& motor : description::motor_limits(model.devices[device])) {
      if (mechanism().joint(motor.joint).dofs == 0)
        throw std::invalid_argument("motor '" + name + "' drives the fixed joint '" + model.joints[motor.joint].name +
                                    "'");
      add_motor(mechanism().joint(motor.joint).first_dof, motor.max_effort, motor.max_velocity, name);
    }
    for (const DeviceOutputs::Output& output : outputs.of(DeviceId{device}))
      if (const auto* const side = std::get_if<DeviceOutputs::Wheels>(&output))
        for (const DeviceOutputs::Wheel& wheel : side->wheels)
          add_motor(wheel.dof, side->max_effort, side->max_velocity, name);
  }
  for (const description::TrackPair* const pair : outputs.tracks)
    treels_.emplace_back(model, *pair, mechanism().link(pair->link).X_SL);
}

void Multibody::add_motor(int dof, double max_effort, double max_velocity, const std::string& device) {
  if (joints_.has_motor(dof))
    throw std::invalid_argument("motor '" + device + "' drives a joint that already has a motor");
  joints_.add_motor(dof, max_effort, max_velocity);
}

bool Multibody::set_joint_target(std::size_t joint, JointRows::Control control, double target) {
  return joints_.set_target(mechanism().joint(joint).first_dof, control, target);
}

double Multibody::joint_effort(std::size_t joint) const {
  const Mechanism::JointPlace& place = mechanism().joint(joint);
  if (place.dofs == 0 || !joints_.has_motor(place.first_dof) || last_step_ == 0.0) return 0.0;
  return joints_.motor_impulse(place.first_dof) / last_step_;
}

bool Multibody::set_target(const DeviceOutputs::Wheels& side, double velocity) {
  bool is_new = false;
  for (const DeviceOutputs::Wheel& wheel : side.wheels)
    is_new |= joints_.set_target(wheel.dof, JointRows::Control::velocity, wheel.sense * velocity / side.radius);
  return is_new;
}

// Returns the mean over the wheels of one side: they turn alike except for slip.
OutputState Multibody::state(const DeviceOutputs::Wheels& side) const {
  OutputState state;
  for (const auto& [dof, sense] : side.wheels) {
    state.position += sense * motion_.coordinate(mechanism().dofs()[static_cast<std::size_t>(dof)]) * side.radius;
    state.velocity += sense * motion_.velocities()[dof] * side.radius;
    if (last_step_ > 0.0) state.effort += sense * joints_.motor_impulse(dof) / last_step_ / side.radius;
  }
  if (const auto count = static_cast<double>(side.wheels.size()); count > 0.0) {
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
