// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "server/actuation/actuator.hpp"

/// The register of actuators, by their type in a model. Each has a file of its own, and a new kind adds one line here.
namespace cohort::actuation {

/// The base of a kind of actuator: a device of a model, and its mount.
template <class Device>
class ActuatorOf : public Actuator {
 public:
  ActuatorOf(const Device& device, const Mount& mount) : device_(device), mount_(mount) {}

 protected:
  const Device& device_;  // in the model
  Mount mount_;
};

std::unique_ptr<Actuator> make_actuator(const description::AckermannDrive& drive, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::Belt& belt, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::DetachableJoint& joint, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::DifferentialDrive& drive, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::EffortMotor& motor, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::Gripper& gripper, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::LedRing& leds, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::Loudspeaker& speaker, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::PositionMotor& motor, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::RangeAndBearing& device, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::Rotor& rotor, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::TrackedDrive& drive, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::TreelDrive& drive, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::UserAction& action, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::VelocityMotor& motor, const Mount& mount);

}  // namespace cohort::actuation
