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

// Of the wheels alone: the fastest is that on the outside of a turn.
template <class Drive>
std::vector<MotorLimits> wheel_motors(const Drive& drive) {
  const double fastest = (drive.max_linear + 0.5 * drive.wheel_separation * drive.max_angular) / drive.wheel_radius;
  std::vector<MotorLimits> motors;
  for (const std::vector<std::size_t>* joints : {&drive.left_joints, &drive.right_joints})
    for (const std::size_t joint : *joints) motors.push_back({joint, fastest, drive.max_torque, 0.0});
  return motors;
}

}  // namespace

Device::Device() = default;
Device::Device(const Device& other) = default;
Device::Device(Device&& other) noexcept = default;
Device& Device::operator=(const Device& other) = default;
Device& Device::operator=(Device&& other) noexcept = default;
Device::~Device() = default;

Readout* readout_of(Device& device) { return std::visit(FindReadout<Readout>{}, device); }
const Readout* readout_of(const Device& device) { return std::visit(FindReadout<const Readout>{}, device); }

const std::string& name_of(const Device& device) {
  return std::visit([](const auto& kind) -> const std::string& { return kind.name; }, device);
}

std::vector<MotorLimits> motor_limits(const Device& device) {
  if (const auto* motor = std::get_if<VelocityMotor>(&device))
    return {{motor->joint, motor->max_velocity, motor->max_effort, motor->rotor_inertia}};
  if (const auto* motor = std::get_if<PositionMotor>(&device))
    return {{motor->joint, motor->max_velocity, motor->max_effort, motor->rotor_inertia}};
  if (const auto* motor = std::get_if<EffortMotor>(&device))
    return {{motor->joint, std::numeric_limits<double>::infinity(), motor->max_effort, motor->rotor_inertia}};
  if (const auto* drive = std::get_if<DifferentialDrive>(&device)) return wheel_motors(*drive);
  if (const auto* drive = std::get_if<AckermannDrive>(&device)) {
    std::vector<MotorLimits> motors = wheel_motors(*drive);
    for (const std::size_t joint : {drive->left_steering_joint, drive->right_steering_joint})
      motors.push_back({joint, drive->max_steering_velocity, drive->max_steering_torque, 0.0});
    return motors;
  }
  return {};
}

std::vector<BeltPlace> belts_of(const Device& device) {
  if (const auto* belt = std::get_if<Belt>(&device)) return {{belt->link, belt->axis_L.normalized()}};
  std::vector<BeltPlace> belts;
  if (const auto* drive = std::get_if<TrackedDrive>(&device))
    for (const std::vector<std::size_t>* links : {&drive->left_links, &drive->right_links})
      for (const std::size_t link : *links) belts.push_back({link, Eigen::Vector3d::UnitY()});
  return belts;
}

}  // namespace cohort::description
