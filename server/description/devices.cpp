#include "server/description/devices.hpp"

#include <limits>

namespace cohort::description {
namespace {

template <class ReadoutType>
struct FindReadout {
  template <class Kind>
  ReadoutType* operator()(Kind& kind) const {
    if constexpr (requires { kind.readout; })
      return &kind.readout;
    else
      return nullptr;
  }
};

}  // namespace

Readout* readout_of(Device& device) { return std::visit(FindReadout<Readout>{}, device); }
const Readout* readout_of(const Device& device) { return std::visit(FindReadout<const Readout>{}, device); }

const std::string& name_of(const Device& device) {
  return std::visit([](const auto& kind) -> const std::string& { return kind.name; }, device);
}

std::optional<MotorLimits> motor_limits(const Device& device) {
  if (const auto* motor = std::get_if<VelocityMotor>(&device))
    return MotorLimits{motor->joint, motor->max_velocity, motor->max_effort, motor->rotor_inertia};
  if (const auto* motor = std::get_if<PositionMotor>(&device))
    return MotorLimits{motor->joint, motor->max_velocity, motor->max_effort, motor->rotor_inertia};
  if (const auto* motor = std::get_if<EffortMotor>(&device))
    return MotorLimits{motor->joint, std::numeric_limits<double>::infinity(), motor->max_effort, motor->rotor_inertia};
  return std::nullopt;
}

}  // namespace cohort::description
