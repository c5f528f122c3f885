#pragma once

#include <memory>

#include "server/actuation/actuator.hpp"

/// The register of actuators, by what a model says of them: each stands in a file of its own, and a new kind is one
/// more line here.
namespace cohort::actuation {

std::unique_ptr<Actuator> make_actuator(const description::EffortMotor& motor, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::Gripper& gripper, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::LedRing& leds, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::Loudspeaker& speaker, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::PositionMotor& motor, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::RangeAndBearing& device, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::TreelDrive& drive, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::UserAction& action, const Mount& mount);
std::unique_ptr<Actuator> make_actuator(const description::VelocityMotor& motor, const Mount& mount);

}  // namespace cohort::actuation
