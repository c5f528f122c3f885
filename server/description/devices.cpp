// SPDX-License-Identifier: Apache-2.0
#include "server/description/devices.hpp"

#include <cmath>
#include <limits>
#include <type_traits>

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

// Returns the result of `ask` for the kind of the device, or a default value if it does not apply to that kind.
template <class Answer, class Ask>
Answer answer_of(const Device& device, const Ask& ask) {
  return std::visit(
      [&](const auto& kind) -> Answer {
        if constexpr (requires { ask(kind); })
          return ask(kind);
        else
          return {};
      },
      device);
}

template <class Part>
const Part* part_of(const Device& device) {
  return std::visit(
      []<class Kind>(const Kind& kind) -> const Part* {
        if constexpr (std::is_base_of_v<Part, Kind>)
          return &kind;
        else
          return nullptr;
      },
      device);
}

// Returns the motors of the wheels; the fastest wheel is on the outside of a turn.
template <class Drive>
std::vector<MotorLimits> wheel_motors(const Drive& drive) {
  const double fastest = (drive.max_linear + 0.5 * drive.wheel_separation * drive.max_angular) / drive.wheel_radius;
  std::vector<MotorLimits> motors;
  for (const std::vector<std::size_t>* joints : {&drive.left_joints, &drive.right_joints})
    for (const std::size_t joint : *joints) motors.push_back({joint, fastest, drive.max_torque, 0.0});
  return motors;
}

Pose on_ring(const Pose& X_LS, double bearing, double radius) {
  const Pose X_SE{{radius * std::cos(bearing), radius * std::sin(bearing), 0.0},
                  Eigen::Quaterniond(Eigen::AngleAxisd(bearing, Eigen::Vector3d::UnitZ()))};
  return X_LS * X_SE;
}

}  // namespace

std::vector<MotorLimits> VelocityMotor::motors() const { return {{joint, max_velocity, max_effort, rotor_inertia}}; }

std::vector<MotorLimits> PositionMotor::motors() const { return {{joint, max_velocity, max_effort, rotor_inertia}}; }

std::vector<MotorLimits> EffortMotor::motors() const {
  return {{joint, std::numeric_limits<double>::infinity(), max_effort, rotor_inertia}};
}

std::vector<MotorLimits> DifferentialDrive::motors() const { return wheel_motors(*this); }

std::vector<MotorLimits> AckermannDrive::motors() const {
  std::vector<MotorLimits> motors = wheel_motors(*this);
  for (const std::size_t joint : {left_steering_joint, right_steering_joint})
    motors.push_back({joint, max_steering_velocity, max_steering_torque, 0.0});
  return motors;
}

std::vector<BeltPlace> Belt::belts() const { return {{link, axis_L.normalized()}}; }

std::vector<BeltPlace> TrackedDrive::belts() const {
  std::vector<BeltPlace> belts;
  for (const std::vector<std::size_t>* links : {&left_links, &right_links})
    for (const std::size_t link : *links) belts.push_back({link, Eigen::Vector3d::UnitY()});
  return belts;
}

std::vector<DeviceEmitter> LedRing::emitters() const {
  std::vector<DeviceEmitter> emitters;
  for (std::size_t i = 0; i < count; ++i) {
    const Pose X_LE = on_ring(X_LS, first_bearing + static_cast<double>(i) * spacing, ring_radius);
    emitters.push_back({link, X_LE, Marker{Eigen::Vector3d::Zero()}});
    if (!(intensity > 0.0)) continue;
    Light light;
    light.color.setZero();
    light.intensity = intensity;
    emitters.push_back({link, X_LE, light});
  }
  return emitters;
}

std::vector<DeviceEmitter> Loudspeaker::emitters() const { return {{link, X_LE, Sound{0.0, 0.0}}}; }

std::vector<DeviceEmitter> RangeAndBearing::emitters() const { return {{link, X_LS, Beacon{range, message_size}}}; }

HeldChild DetachableJoint::held_child() const { return {link, child, child_link, may_be_missing, child_place}; }

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
  return answer_of<std::vector<MotorLimits>>(device,
                                             [](const auto& kind) -> decltype(kind.motors()) { return kind.motors(); });
}

std::vector<BeltPlace> belts_of(const Device& device) {
  return answer_of<std::vector<BeltPlace>>(device,
                                           [](const auto& kind) -> decltype(kind.belts()) { return kind.belts(); });
}

const TrackPair* tracks_of(const Device& device) { return part_of<TrackPair>(device); }

const Thruster* thruster_of(const Device& device) { return part_of<Thruster>(device); }

std::size_t output_count(const Device& device) {
  return (tracks_of(device) != nullptr ? 2 : 0) + belts_of(device).size() + (thruster_of(device) != nullptr ? 1 : 0);
}

std::vector<DeviceEmitter> emitters_of(const Device& device) {
  return answer_of<std::vector<DeviceEmitter>>(
      device, [](const auto& kind) -> decltype(kind.emitters()) { return kind.emitters(); });
}

std::optional<HeldChild> held_child_of(const Device& device) {
  return answer_of<std::optional<HeldChild>>(
      device, [](const auto& kind) -> decltype(kind.held_child()) { return kind.held_child(); });
}

std::string reason_against_planar(const Device& device) {
  const std::string what = answer_of<std::string>(
      device, [](const auto& kind) -> decltype(std::string(kind.not_planar)) { return kind.not_planar; });
  return what.empty() ? what : "planar physics does not support " + what + " '" + name_of(device) + "'";
}

}  // namespace cohort::description
