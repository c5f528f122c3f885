#include <cmath>

#include "server/description/device_reader.hpp"

namespace cohort::description {
namespace {

std::optional<Device> read_joint_encoder(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> joint = reader.find_moving_joint(values);
  if (!joint) return std::nullopt;
  return JointEncoder{values.name(), *joint};
}

std::optional<Device> read_treel_encoder(const ExtensionValues& values, DeviceReader& reader) {
  const auto drive = reader.drives().find(values.text("drive"));
  if (drive != reader.drives().end()) return TreelEncoder{values.name(), drive->second};
  std::vector<std::string> names;
  for (const auto& [name, index] : reader.drives()) names.push_back(name);
  reader.report().problem(values.where("drive"), "the model has no treel_drive '" + values.text("drive") + "'" +
                                                     suggestion(values.text("drive"), names));
  return std::nullopt;
}

std::optional<Device> read_proximity_ring(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  if (!link) return std::nullopt;
  ProximityRing ring;
  ring.name = values.name();
  ring.link = *link;
  ring.X_LS = values.pose("pose");
  ring.count = values.whole("count");
  ring.first_bearing = values.real("first_bearing");
  ring.spacing = values.real("spacing");
  ring.ring_radius = values.real("ring_radius");
  ring.range = values.real("range");
  return ring;
}

std::optional<Device> read_ground_sensors(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  if (!link) return std::nullopt;
  return GroundSensors{values.name(), *link, values.vectors("place"), values.real("range")};
}

std::optional<Device> read_light_sensors(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  if (!link) return std::nullopt;
  LightSensors sensors;
  sensors.name = values.name();
  sensors.link = *link;
  sensors.X_LS = values.pose("pose");
  sensors.count = values.whole("count");
  sensors.first_bearing = values.real("first_bearing");
  sensors.spacing = values.real("spacing");
  sensors.gain = values.real("gain");
  return sensors;
}

std::optional<Device> read_microphones(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  const std::vector<Eigen::Vector2d> bands = values.points("band");
  for (std::size_t i = 0; i < bands.size(); ++i)
    if (bands[i].x() > bands[i].y())
      reader.report().problem(values.where("band", i), "the lowest frequency of the band exceeds the highest");
  if (!link) return std::nullopt;
  return Microphones{values.name(), *link, values.vectors("place"), bands, values.real("gain")};
}

// Of a sensor that has a place on a link and nothing else.
template <class Posed>
std::optional<Device> read_posed(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  if (!link) return std::nullopt;
  return Posed{values.name(), *link, values.pose("pose")};
}

void add_noise(Readout& readout, const char* quantity, double deviation) {
  if (!(deviation > 0.0)) return;
  readout.noises.emplace_back();
  readout.noises.back().quantity = quantity;
  readout.noises.back().deviation = deviation;
}

std::optional<Device> read_range_and_bearing(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  if (!link) return std::nullopt;
  RangeAndBearing device;
  device.name = values.name();
  device.link = *link;
  device.X_LS = values.pose("pose");
  device.range = values.real("range");
  device.message_size = values.whole("message_size");
  device.capacity = values.whole("capacity");
  add_noise(device.readout, "range", values.real("range_noise"));
  add_noise(device.readout, "bearing", values.real("bearing_noise"));
  add_noise(device.readout, "elevation", values.real("bearing_noise"));
  return device;
}

std::optional<Device> read_climate_sensor(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  if (!link) return std::nullopt;
  ClimateSensor sensor{values.name(), *link, values.vector("place")};
  add_noise(sensor.readout, "temperature", values.real("temperature_noise"));
  add_noise(sensor.readout, "humidity", values.real("humidity_noise"));
  return sensor;
}

std::optional<Device> read_battery(const ExtensionValues& values, DeviceReader& reader) {
  Battery battery{values.name(), values.real("capacity"), values.real("charge"), values.real("idle_power"),
                  values.real("motor_efficiency")};
  if (battery.motor_efficiency > 1.0) reader.report().problem(values.where("motor_efficiency"), "expected at most 1");
  return battery;
}

std::optional<Device> read_torque_sensor(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> joint = reader.find_moving_joint(values);
  if (!joint) return std::nullopt;
  return TorqueSensor{values.name(), *joint};
}

std::optional<Device> read_traction_sensor(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> joint = reader.find(values, "joint", reader.model().joints);
  if (!joint) return std::nullopt;
  return TractionSensor{values.name(), *joint};
}

// The register of sensors: a new kind is one more line here.
constexpr DeviceKind kinds[] = {
    {"joint_encoder", &read_joint_encoder},
    {"treel_encoder", &read_treel_encoder},
    {"proximity_ring", &read_proximity_ring},
    {"ground_sensors", &read_ground_sensors},
    {"light_sensors", &read_light_sensors},
    {"microphones", &read_microphones},
    {"range_and_bearing", &read_range_and_bearing, true, true},
    {"climate_sensor", &read_climate_sensor},
    {"torque_sensor", &read_torque_sensor},
    {"traction_sensor", &read_traction_sensor},
    {"battery", &read_battery},
    {"inclinometer", &read_posed<Inclinometer>},
};

}  // namespace

std::span<const DeviceKind> sensor_kinds() { return kinds; }

std::chrono::nanoseconds to_time(double seconds) {
  constexpr double nanoseconds = 1e9;
  constexpr double longest = 9e9;  // 285 years, which fits into nanoseconds [s]
  return std::chrono::nanoseconds(static_cast<std::int64_t>(std::round(std::min(seconds, longest) * nanoseconds)));
}

Readout read_readout(const ExtensionValues& values) {
  Noise noise;
  noise.deviation = values.real("noise");
  noise.uniform = values.real("uniform_noise");
  noise.bias = values.real("bias");
  noise.bias_deviation = values.real("bias_noise");
  noise.precision = values.real("precision");
  Readout readout;
  if (!is_exact(noise)) readout.noises.push_back(noise);
  readout.drop_out = values.real("drop_out");
  if (values.has("rate")) readout.period = to_time(1.0 / values.real("rate"));
  readout.latency = to_time(values.real("latency"));
  return readout;
}

}  // namespace cohort::description
