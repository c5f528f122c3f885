#include <cmath>

#include "server/parsing/keys/device_keys.hpp"
#include "server/parsing/writing/write_sdf_sensors.hpp"
#include "server/parsing/writing/write_values.hpp"

namespace cohort::parsing {
namespace {

constexpr double nanoseconds = 1e9;

template <class Value>
void add_unless(XmlNode& element, const char* key, Value value, Value usual) {
  if (value != usual) add_key(element, key, value);
}

// Of the noise on one quantity; 0 if it has none of its own.
double deviation_of(const Readout& readout, const std::string& quantity) {
  for (const Noise& noise : readout.noises)
    if (noise.quantity == quantity) return noise.deviation;
  return 0.0;
}

void write_readout(XmlNode& element, const Readout& readout) {
  for (const Noise& noise : readout.noises) {
    if (!noise.quantity.empty()) continue;  // keys of the device's own
    add_unless(element, "noise", noise.deviation, 0.0);
    add_unless(element, "uniform_noise", noise.uniform, 0.0);
    add_unless(element, "bias", noise.bias, 0.0);
    add_unless(element, "bias_noise", noise.bias_deviation, 0.0);
    add_unless(element, "precision", noise.precision, 0.0);
  }
  add_unless(element, "drop_out", readout.drop_out, 0.0);
  if (readout.period.count() > 0) add_key(element, "rate", nanoseconds / static_cast<double>(readout.period.count()));
  add_unless(element, "latency", static_cast<double>(readout.latency.count()) / nanoseconds, 0.0);
}

struct DeviceWriter {
  XmlNode& parent;  // the model
  const Model& model;
  const std::filesystem::path& folder;

  void operator()(const TreelDrive& drive) const {
    XmlNode& element = add_named(parent, prefixed("treel_drive"), drive.name);
    add_key(element, "link", link_name(drive.link));
    add_key(element, "half_gauge", drive.half_gauge);
    add_key(element, "half_contact_length", drive.half_contact_length);
    add_key(element, "ground_height", drive.ground_height);
    add_key(element, "wheel_radius", drive.wheel_radius);
    add_key(element, "max_torque", drive.max_torque);
    add_key(element, "max_velocity", drive.max_velocity);
    add_key(element, "friction", drive.friction);
    for (const std::size_t joint : drive.left_wheels) add_key(element, "left_wheel", joint_name(joint));
    for (const std::size_t joint : drive.right_wheels) add_key(element, "right_wheel", joint_name(joint));
  }
  void operator()(const VelocityMotor& motor) const { write_motor("velocity_motor", motor); }
  void operator()(const PositionMotor& motor) const { write_motor("position_motor", motor); }
  void operator()(const EffortMotor& motor) const { write_motor("effort_motor", motor); }
  void operator()(const JointEncoder& encoder) const {
    XmlNode& element = add_named(parent, prefixed("joint_encoder"), encoder.name);
    add_key(element, "joint", joint_name(encoder.joint));
    write_readout(element, encoder.readout);
  }
  void operator()(const TreelEncoder& encoder) const {
    XmlNode& element = add_named(parent, prefixed("treel_encoder"), encoder.name);
    add_key(element, "drive", std::get<TreelDrive>(model.devices[encoder.drive]).name);
    write_readout(element, encoder.readout);
  }
  void operator()(const ProximityRing& ring) const {
    XmlNode& element = add_named(parent, prefixed("proximity_ring"), ring.name);
    add_key(element, "link", link_name(ring.link));
    add_key(element, "pose", ring.X_LS);
    add_key(element, "count", static_cast<std::uint64_t>(ring.count));
    add_key(element, "first_bearing", ring.first_bearing);
    add_key(element, "spacing", ring.spacing);
    add_key(element, "ring_radius", ring.ring_radius);
    add_key(element, "range", ring.range);
    if (ring.technique != ProximityTechnique::ray) {
      add_key(element, "technique", std::string(keys::proximity_techniques[static_cast<std::size_t>(ring.technique)]));
      add_key(element, "cone", ring.cone);
    }
    write_samples(element, ring.samples);
    write_readout(element, ring.readout);
  }
  void operator()(const GroundSensors& sensors) const {
    XmlNode& element = add_named(parent, prefixed("ground_sensors"), sensors.name);
    add_key(element, "link", link_name(sensors.link));
    for (const Eigen::Vector3d& place : sensors.places_L) add_key(element, "place", place);
    add_key(element, "range", sensors.range);
    write_readout(element, sensors.readout);
  }
  void operator()(const LightSensors& sensors) const {
    XmlNode& element = add_named(parent, prefixed("light_sensors"), sensors.name);
    add_key(element, "link", link_name(sensors.link));
    add_key(element, "pose", sensors.X_LS);
    add_key(element, "count", static_cast<std::uint64_t>(sensors.count));
    add_key(element, "first_bearing", sensors.first_bearing);
    add_key(element, "spacing", sensors.spacing);
    add_key(element, "gain", sensors.gain);
    write_samples(element, sensors.samples);
    write_readout(element, sensors.readout);
  }
  void operator()(const Microphones& microphones) const {
    XmlNode& element = add_named(parent, prefixed("microphones"), microphones.name);
    add_key(element, "link", link_name(microphones.link));
    for (const Eigen::Vector3d& place : microphones.places_L) add_key(element, "place", place);
    for (const Eigen::Vector2d& band : microphones.bands) add_key(element, "band", band);
    add_key(element, "gain", microphones.gain);
    write_samples(element, microphones.samples);
    write_readout(element, microphones.readout);
  }
  void operator()(const Accelerometer& sensor) const { write_posed("accelerometer", sensor); }
  void operator()(const Inclinometer& sensor) const { write_posed("inclinometer", sensor); }
  /// SDF's own sensors.
  template <class SdfSensor>
  void operator()(const SdfSensor& sensor) const {
    write_sdf_sensor(parent, model, sensor);
  }
  void operator()(const RangeAndBearing& device) const {
    XmlNode& element = add_named(parent, prefixed("range_and_bearing"), device.name);
    add_key(element, "link", link_name(device.link));
    add_key(element, "pose", device.X_LS);
    add_key(element, "range", device.range);
    add_key(element, "message_size", static_cast<std::uint64_t>(device.message_size));
    add_key(element, "capacity", static_cast<std::uint64_t>(device.capacity));
    add_key(element, "range_noise", deviation_of(device.readout, "range"));
    add_key(element, "bearing_noise", deviation_of(device.readout, "bearing"));
    write_readout(element, device.readout);
  }
  void operator()(const ClimateSensor& sensor) const {
    XmlNode& element = add_named(parent, prefixed("climate_sensor"), sensor.name);
    add_key(element, "link", link_name(sensor.link));
    add_key(element, "place", sensor.p_LS);
    add_key(element, "temperature_noise", deviation_of(sensor.readout, "temperature"));
    add_key(element, "humidity_noise", deviation_of(sensor.readout, "humidity"));
    write_readout(element, sensor.readout);
  }
  void operator()(const OmnidirectionalCamera& camera) const {
    XmlNode& element = add_named(parent, prefixed("omnidirectional_camera"), camera.name);
    add_key(element, "link", link_name(camera.link));
    add_key(element, "pose", camera.X_LS);
    add_key(element, "range", camera.range);
    add_key(element, "min_elevation", camera.min_elevation);
    add_key(element, "max_elevation", camera.max_elevation);
    add_key(element, "capacity", static_cast<std::uint64_t>(camera.capacity));
    add_key(element, "distance_noise", deviation_of(camera.readout, "distance"));
    add_key(element, "bearing_noise", deviation_of(camera.readout, "bearing"));
    write_readout(element, camera.readout);
  }
  void operator()(const PanoramicCamera& camera) const {
    XmlNode& element = add_named(parent, prefixed("panorama"), camera.name);
    add_key(element, "link", link_name(camera.link));
    add_key(element, "pose", camera.X_LS);
    add_key(element, "width", static_cast<std::uint64_t>(camera.width));
    add_key(element, "height", static_cast<std::uint64_t>(camera.height));
    add_key(element, "min_elevation", camera.min_elevation);
    add_key(element, "max_elevation", camera.max_elevation);
    if (std::isfinite(camera.range)) add_key(element, "range", camera.range);
    add_key(element, "sky", camera.sky);
    write_readout(element, camera.readout);
  }
  void operator()(const Battery& battery) const {
    XmlNode& element = add_named(parent, prefixed("battery"), battery.name);
    add_key(element, "capacity", battery.capacity);
    add_key(element, "charge", battery.charge);
    add_key(element, "idle_power", battery.idle_power);
    add_key(element, "motor_efficiency", battery.motor_efficiency);
    write_readout(element, battery.readout);
  }
  void operator()(const LedRing& leds) const {
    XmlNode& element = add_named(parent, prefixed("led_ring"), leds.name);
    add_key(element, "link", link_name(leds.link));
    add_key(element, "pose", leds.X_LS);
    add_key(element, "count", static_cast<std::uint64_t>(leds.count));
    add_key(element, "first_bearing", leds.first_bearing);
    add_key(element, "spacing", leds.spacing);
    add_key(element, "ring_radius", leds.ring_radius);
    add_key(element, "intensity", leds.intensity);
  }
  void operator()(const Loudspeaker& speaker) const {
    XmlNode& element = add_named(parent, prefixed("loudspeaker"), speaker.name);
    add_key(element, "link", link_name(speaker.link));
    add_key(element, "pose", speaker.X_LE);
    add_key(element, "max_frequency", speaker.max_frequency);
    add_key(element, "max_intensity", speaker.max_intensity);
  }

  void operator()(const Gripper& gripper) const {
    XmlNode& element = add_named(parent, prefixed("gripper"), gripper.name);
    add_key(element, "link", link_name(gripper.link));
    add_key(element, "pose", gripper.X_LG);
    add_key(element, "depth", gripper.depth);
    add_key(element, "half_angle", gripper.half_angle);
    add_key(element, "height", gripper.height);
    add_key(element, "closing_time", gripper.closing_time);
    add_key(element, "holding_force", gripper.holding_force);
    add_key(element, "holding_torque", gripper.holding_torque);
    if (std::isfinite(gripper.breaking_force)) add_key(element, "breaking_force", gripper.breaking_force);
    if (std::isfinite(gripper.breaking_torque)) add_key(element, "breaking_torque", gripper.breaking_torque);
    const bool is_beam = gripper.light_barrier == Gripper::LightBarrier::beam;
    add_key(element, "light_barrier", std::string(is_beam ? "beam" : "simple"));
    add_key(element, "jaw_width", gripper.jaw_width);
    write_readout(element, gripper.readout);
  }
  void operator()(const UserAction& action) const { add_named(parent, prefixed("action"), action.name); }
  void operator()(const TorqueSensor& sensor) const { write_joint_sensor("torque_sensor", sensor); }
  void operator()(const TractionSensor& sensor) const { write_joint_sensor("traction_sensor", sensor); }

 private:
  void write_samples(XmlNode& element, const std::shared_ptr<const Samples>& samples) const {
    if (samples) add_key(element, "samples", relative_to(folder, samples->file));
  }
  template <class OnJoint>
  void write_joint_sensor(const char* kind, const OnJoint& sensor) const {
    XmlNode& element = add_named(parent, prefixed(kind), sensor.name);
    add_key(element, "joint", joint_name(sensor.joint));
    write_readout(element, sensor.readout);
  }
  template <class Motor>
  void write_motor(const char* kind, const Motor& motor) const {
    XmlNode& element = add_named(parent, prefixed(kind), motor.name);
    add_key(element, "joint", joint_name(motor.joint));
    if constexpr (requires { motor.max_velocity; }) add_key(element, "max_velocity", motor.max_velocity);
    add_key(element, "max_effort", motor.max_effort);
    add_unless(element, "rotor_inertia", motor.rotor_inertia, 0.0);
  }
  template <class Posed>
  void write_posed(const char* kind, const Posed& sensor) const {
    XmlNode& element = add_named(parent, prefixed(kind), sensor.name);
    add_key(element, "link", link_name(sensor.link));
    add_key(element, "pose", sensor.X_LS);
    write_readout(element, sensor.readout);
  }
  std::string link_name(std::size_t link) const { return without_scope_marks(model.links[link].name); }
  std::string joint_name(std::size_t joint) const { return without_scope_marks(model.joints[joint].name); }
};

struct EmitterWriter {
  XmlNode& parent;  // the link
  const Emitter& emitter;

  void operator()(const Light& light) const {
    const char* const kinds[] = {"point", "spot", "directional"};
    XmlNode& element = add_named(parent, "light", emitter.name);
    element.attributes.emplace_back("type", kinds[static_cast<int>(light.kind)]);
    add_pose(element, emitter.X_LE);
    add_value(element, "intensity", light.intensity);
    add_value(element, "diffuse", light.color).text += " 1";
    add_value(element, "direction", light.direction_E);
    XmlNode& attenuation = add(element, "attenuation");
    add_value(attenuation, "range", light.range);
    add_value(attenuation, "constant", light.constant);
    add_value(attenuation, "linear", light.linear);
    add_value(attenuation, "quadratic", light.quadratic);
    if (light.kind != Light::Kind::spot) return;
    XmlNode& spot = add(element, "spot");
    add_value(spot, "inner_angle", 2.0 * light.inner_angle);
    add_value(spot, "outer_angle", 2.0 * light.outer_angle);
    add_value(spot, "falloff", light.falloff);
  }
  void operator()(const Sound& sound) const {
    XmlNode& element = extension("sound");
    add_key(element, "frequency", sound.frequency);
    add_key(element, "intensity", sound.intensity);
    if (std::isfinite(sound.range)) add_key(element, "range", sound.range);
  }
  void operator()(const Marker& marker) const { add_key(extension("marker"), "color", marker.color); }
  void operator()(const ClimateSource& source) const {
    XmlNode& element = extension("climate_source");
    add_key(element, "temperature", source.temperature);
    add_key(element, "humidity", source.humidity);
    add_key(element, "spread", source.spread);
  }

 private:
  XmlNode& extension(const char* name) const {
    XmlNode& element = add_named(parent, prefixed(name), emitter.name);
    add_key(element, "pose", emitter.X_LE);
    add_key(element, "on", emitter.is_on);
    return element;
  }
};

}  // namespace

std::string text_of(double number) {
  char buffer[32];
  const auto end = std::to_chars(std::begin(buffer), std::end(buffer), number).ptr;
  return {std::begin(buffer), end};
}
std::string text_of(const Eigen::Vector2d& v) { return text_of(v.x()) + " " + text_of(v.y()); }
std::string text_of(const Eigen::Vector3d& v) { return text_of(v.x()) + " " + text_of(v.y()) + " " + text_of(v.z()); }
std::string text_of(const Pose& X) {
  const Eigen::Quaterniond& q = X.orientation;
  return text_of(X.position) + " " + text_of(q.x()) + " " + text_of(q.y()) + " " + text_of(q.z()) + " " +
         text_of(q.w());
}

std::string without_scope_marks(std::string name) {
  for (std::size_t at = name.find("::"); at != std::string::npos; at = name.find("::", at)) name.replace(at, 2, ".");
  return name;
}

std::string relative_to(const std::filesystem::path& folder, const std::filesystem::path& file) {
  return std::filesystem::absolute(file).lexically_normal().lexically_proximate(
      std::filesystem::absolute(folder).lexically_normal());
}

void write_device(XmlNode& model_element, const Model& model, const Device& device,
                  const std::filesystem::path& folder) {
  std::visit(DeviceWriter{model_element, model, folder}, device);
}

void write_grip_ring(XmlNode& link_element, const GripRing& ring) {
  XmlNode& element = add_named(link_element, prefixed("grip_ring"), ring.name);
  add_key(element, "pose", ring.X_LR);
  add_key(element, "radius", ring.radius);
}

void write_emitter(XmlNode& link_element, const Emitter& emitter) {
  std::visit(EmitterWriter{link_element, emitter}, emitter.what);
}

}  // namespace cohort::parsing
