#include "server/parsing/model/device_reader.hpp"

namespace cohort::parsing {
namespace {

std::optional<Device> read_treel_drive(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  if (!link) return std::nullopt;
  if (*link != 0) {
    reader.report().problem(values.where("link"), "expected the root link, '" + reader.model().links[0].name + "'");
    return std::nullopt;
  }
  TreelDrive drive;
  drive.name = values.name();
  drive.link = *link;
  drive.half_gauge = values.real("half_gauge");
  drive.half_contact_length = values.real("half_contact_length");
  drive.ground_height = values.real("ground_height");
  drive.wheel_radius = values.real("wheel_radius");
  drive.max_torque = values.real("max_torque");
  drive.max_velocity = values.real("max_velocity");
  drive.friction = values.real("friction");
  drive.left_wheels = reader.take_wheels(values, "left_wheel", drive.link);
  drive.right_wheels = reader.take_wheels(values, "right_wheel", drive.link);
  return drive;
}

template <class Motor>
std::optional<Device> read_motor(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> joint = reader.find_moving_joint(values);
  if (!joint || !reader.takes_motor(*joint, values)) return std::nullopt;
  return Motor{values.name(), *joint, values.real("max_velocity"), values.real("max_effort"),
               values.real("rotor_inertia")};
}

std::optional<Device> read_effort_motor(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> joint = reader.find_moving_joint(values);
  if (!joint || !reader.takes_motor(*joint, values)) return std::nullopt;
  return EffortMotor{values.name(), *joint, values.real("max_effort"), values.real("rotor_inertia")};
}

std::optional<Device> read_led_ring(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  if (!link) return std::nullopt;
  return LedRing{values.name(),
                 *link,
                 values.pose("pose"),
                 values.whole("count"),
                 values.real("first_bearing"),
                 values.real("spacing"),
                 values.real("ring_radius"),
                 values.real("intensity")};
}

std::optional<Device> read_loudspeaker(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  if (!link) return std::nullopt;
  return Loudspeaker{values.name(), *link, values.pose("pose"), values.real("max_frequency"),
                     values.real("max_intensity")};
}

std::optional<Device> read_gripper(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  if (!link) return std::nullopt;
  Gripper gripper;
  gripper.name = values.name();
  gripper.link = *link;
  gripper.X_LG = values.pose("pose");
  gripper.depth = values.real("depth");
  gripper.half_angle = values.real("half_angle");
  gripper.height = values.real("height");
  gripper.closing_time = values.real("closing_time");
  gripper.holding_force = values.real("holding_force");
  gripper.holding_torque = values.real("holding_torque");
  if (values.has("breaking_force")) gripper.breaking_force = values.real("breaking_force");
  if (values.has("breaking_torque")) gripper.breaking_torque = values.real("breaking_torque");
  if (values.text("light_barrier") == "beam") gripper.light_barrier = Gripper::LightBarrier::beam;
  gripper.jaw_width = values.real("jaw_width");
  return gripper;
}

std::optional<Device> read_action(const ExtensionValues& values, DeviceReader&) { return UserAction{values.name()}; }

// The register of actuators: a new kind is one more line here.
constexpr DeviceKind kinds[] = {
    {"treel_drive", &read_treel_drive, true, false},
    {"velocity_motor", &read_motor<VelocityMotor>, true, false},
    {"position_motor", &read_motor<PositionMotor>, true, false},
    {"effort_motor", &read_effort_motor, true, false},
    {"led_ring", &read_led_ring, true, false},
    {"loudspeaker", &read_loudspeaker, true, false},
    {"gripper", &read_gripper, true, true},
    {"action", &read_action, true, false},
};

}  // namespace

std::span<const DeviceKind> actuator_kinds() { return kinds; }

}  // namespace cohort::parsing
