#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/parsing/keys/device_keys.hpp"
#include "server/parsing/model/device_reader.hpp"

namespace cohort::parsing {
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
  const std::span<const std::string_view> techniques = keys::proximity_techniques;
  const auto technique = std::find(techniques.begin(), techniques.end(), values.text("technique"));
  ring.technique = static_cast<ProximityTechnique>(technique - techniques.begin());
  ring.cone = values.real("cone");
  if (ring.cone >= std::numbers::pi)
    reader.report().problem(values.where("cone"), "expected a cone of less than half a turn, pi");
  ring.samples = reader.find_samples(values, ring.count);
  const bool takes_samples = ring.technique == ProximityTechnique::samples;
  if (takes_samples != values.has("samples"))
    reader.report().problem(values.where("samples"), takes_samples
                                                         ? "the technique 'samples' needs a file <cohort:samples>"
                                                         : "only the technique 'samples' has a file");
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
  sensors.samples = reader.find_samples(values, sensors.count);
  return sensors;
}

std::optional<Device> read_microphones(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  const std::vector<Eigen::Vector2d> bands = values.points("band");
  for (std::size_t i = 0; i < bands.size(); ++i)
    if (bands[i].x() > bands[i].y())
      reader.report().problem(values.where("band", i), "the lowest frequency of the band exceeds the highest");
  if (!link) return std::nullopt;
  Microphones microphones{values.name(), *link, values.vectors("place"), bands, values.real("gain")};
  microphones.samples = reader.find_samples(values, microphones.places_L.size());
  return microphones;
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

void check_elevations(const ExtensionValues& values, DeviceReader& reader) {
  constexpr double quarter_turn = 0.5 * std::numbers::pi;
  for (const char* const key : {"min_elevation", "max_elevation"})
    if (std::abs(values.real(key)) > quarter_turn)
      reader.report().problem(values.where(key), "expected an elevation from -pi/2 to pi/2");
  if (!(values.real("min_elevation") < values.real("max_elevation")))
    reader.report().problem(values.where("max_elevation"), "expected more than the lowest elevation");
}

std::optional<Device> read_omnidirectional_camera(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  check_elevations(values, reader);
  if (!link) return std::nullopt;
  OmnidirectionalCamera camera;
  camera.name = values.name();
  camera.link = *link;
  camera.X_LS = values.pose("pose");
  camera.range = values.real("range");
  camera.min_elevation = values.real("min_elevation");
  camera.max_elevation = values.real("max_elevation");
  camera.capacity = values.whole("capacity");
  add_noise(camera.readout, "distance", values.real("distance_noise"));
  add_noise(camera.readout, "bearing", values.real("bearing_noise"));
  add_noise(camera.readout, "elevation", values.real("bearing_noise"));
  return camera;
}

std::optional<Device> read_panorama(const ExtensionValues& values, DeviceReader& reader) {
  const std::optional<std::size_t> link = reader.find_link(values);
  check_elevations(values, reader);
  constexpr std::uint64_t least_width = 4;
  constexpr std::uint64_t most_pixels = 1'000'000;
  if (values.whole("width") < least_width)
    reader.report().problem(values.where("width"), "expected at least 4 columns");
  if (values.whole("width") * values.whole("height") > most_pixels)
    reader.report().problem(values.where("height"), "expected at most 1 000 000 pixels");
  const Eigen::Vector3d sky = values.vector("sky");
  if (sky.minCoeff() < 0.0 || sky.maxCoeff() > 1.0)
    reader.report().problem(values.where("sky"), "expected red, green and blue from 0 to 1");
  if (!link) return std::nullopt;
  PanoramicCamera camera;
  camera.name = values.name();
  camera.link = *link;
  camera.X_LS = values.pose("pose");
  camera.width = values.whole("width");
  camera.height = values.whole("height");
  camera.min_elevation = values.real("min_elevation");
  camera.max_elevation = values.real("max_elevation");
  if (values.has("range")) camera.range = values.real("range");
  camera.sky = sky;
  return camera;
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
    {"omnidirectional_camera", &read_omnidirectional_camera},
    {"panorama", &read_panorama},
    {"torque_sensor", &read_torque_sensor},
    {"traction_sensor", &read_traction_sensor},
    {"battery", &read_battery},
    {"accelerometer", &read_posed<Accelerometer>},
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

}  // namespace cohort::parsing
