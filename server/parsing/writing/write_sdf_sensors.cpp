// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/writing/write_sdf_sensors.hpp"

#include <cmath>
#include <stdexcept>
#include <string_view>

#include "server/core/infinity.hpp"
#include "server/parsing/writing/write_values.hpp"

namespace cohort::parsing {
namespace {

// Returns the `place`-th child of this kind.
XmlNode& child_of(XmlNode& element, std::string_view kind, std::size_t place) {
  for (XmlNode& child : element.children)
    if (child.name == kind && place-- == 0) return child;
  throw std::logic_error("a sensor is written before its link or joint");
}

XmlNode& add_sensor(XmlNode& owner, const char* type, const std::string& name, const Readout& readout) {
  XmlNode& element = add_named(owner, "sensor", without_scope_marks(name));
  element.attributes.emplace_back("type", type);
  constexpr double nanoseconds = 1e9;
  if (readout.period.count() > 0)
    add_value(element, "update_rate", nanoseconds / static_cast<double>(readout.period.count()));
  return element;
}

template <class Posed>
XmlNode& add_posed_sensor(XmlNode& model, const char* type, const Posed& sensor) {
  XmlNode& element = add_sensor(child_of(model, "link", sensor.link), type, sensor.name, sensor.readout);
  add_pose(element, sensor.X_LS);
  return element;
}

// Returns the noise; nullptr if there is none.
const Noise* noise_on(const Readout& readout, std::string_view quantity, int value) {
  const Noise* found = nullptr;
  for (const Noise& noise : readout.noises)
    if ((noise.quantity.empty() || noise.quantity == quantity) && (noise.element < 0 || noise.element == value))
      found = &noise;
  return found;
}

// Returns the density that gives `deviation` when it is read; the quotient is rounded and may be off by one unit in the
// last place.
double density_of(double deviation, double time) {
  const double factor = drift_from_density(time);
  const double density = deviation / factor;
  for (const double each : {density, std::nextafter(density, 0.0), std::nextafter(density, infinity)})
    if (each * factor == deviation) return each;
  return density;
}

void add_noise(XmlNode& parent, const Readout& readout, std::string_view quantity, int value = 0) {
  const Noise* const noise = noise_on(readout, quantity, value);
  if (noise == nullptr) return;
  XmlNode& element = add(parent, "noise");
  element.attributes.emplace_back("type", noise->precision > 0.0 ? "gaussian_quantized" : "gaussian");
  add_value(element, "mean", noise->mean);
  add_value(element, "stddev", noise->deviation);
  add_value(element, "bias_mean", noise->bias);
  add_value(element, "bias_stddev", noise->bias_deviation);
  if (noise->drift_deviation > 0.0) {
    add_value(element, "dynamic_bias_stddev", density_of(noise->drift_deviation, noise->drift_time));
    add_value(element, "dynamic_bias_correlation_time", noise->drift_time);
  }
  if (noise->precision > 0.0) add_value(element, "precision", noise->precision);
}

// Adds the noises of a quantity of three values.
void add_noises(XmlNode& parent, const Readout& readout, std::string_view quantity) {
  int axis = 0;
  for (const char* const name : {"x", "y", "z"}) {
    if (noise_on(readout, quantity, axis) != nullptr) add_noise(add(parent, name), readout, quantity, axis);
    ++axis;
  }
}

void add_rays(XmlNode& scan, const char* direction, std::size_t count, double least, double greatest) {
  XmlNode& element = add(scan, direction);
  add_value(element, "samples", static_cast<std::uint64_t>(count));
  add_value(element, "resolution", 1.0);
  add_value(element, "min_angle", least);
  add_value(element, "max_angle", greatest);
}

}  // namespace

void write_sdf_sensor(XmlNode& model_element, const Model&, const Lidar& lidar) {
  XmlNode& element = add(add_posed_sensor(model_element, "lidar", lidar), "lidar");
  XmlNode& scan = add(element, "scan");
  add_rays(scan, "horizontal", lidar.columns, lidar.min_bearing, lidar.max_bearing);
  add_rays(scan, "vertical", lidar.rows, lidar.min_elevation, lidar.max_elevation);
  XmlNode& range = add(element, "range");
  add_value(range, "min", lidar.min_range);
  add_value(range, "max", lidar.max_range);
  const Noise* const noise = noise_on(lidar.readout, "ranges", 0);
  if (noise == nullptr) return;
  XmlNode& child = add(element, "noise");
  add_value(child, "type", std::string("gaussian"));
  add_value(child, "mean", noise->mean);
  add_value(child, "stddev", noise->deviation);
}

void write_sdf_sensor(XmlNode& model_element, const Model&, const Imu& imu) {
  XmlNode& element = add(add_posed_sensor(model_element, "imu", imu), "imu");
  XmlNode& reference = add(element, "orientation_reference_frame");
  add_value(reference, "localization", std::string("CUSTOM"));
  XmlNode& rpy = add_value(reference, "custom_rpy", imu.reference_rpy);
  if (imu.is_relative_to_world) rpy.attributes.emplace_back("parent_frame", "world");
  for (const char* const quantity : {"angular_velocity", "linear_acceleration"})
    add_noises(add(element, quantity), imu.readout, quantity);
  add_value(element, "enable_orientation", imu.has_orientation);
}

void write_sdf_sensor(XmlNode& model_element, const Model& model, const ContactSensor& sensor) {
  XmlNode& link = child_of(model_element, "link", sensor.link);
  XmlNode& element = add(add_sensor(link, "contact", sensor.name, sensor.readout), "contact");
  add_value(element, "collision", model.links[sensor.link].collisions[sensor.collision].name);
}

void write_sdf_sensor(XmlNode& model_element, const Model&, const ForceTorqueSensor& sensor) {
  constexpr const char* frames[] = {"child", "parent", "sensor"};
  XmlNode& joint = child_of(model_element, "joint", sensor.joint);
  XmlNode& outer = add_sensor(joint, "force_torque", sensor.name, sensor.readout);
  add_pose(outer, sensor.X_JS);
  XmlNode& element = add(outer, "force_torque");
  add_value(element, "frame", std::string(frames[static_cast<std::size_t>(sensor.axes)]));
  add_value(element, "measure_direction", std::string(sensor.is_on_parent ? "child_to_parent" : "parent_to_child"));
  for (const char* const quantity : {"force", "torque"}) add_noises(add(element, quantity), sensor.readout, quantity);
}

void write_sdf_sensor(XmlNode& model_element, const Model&, const Altimeter& altimeter) {
  XmlNode& element = add(add_posed_sensor(model_element, "altimeter", altimeter), "altimeter");
  for (const char* const quantity : {"vertical_position", "vertical_velocity"})
    add_noise(add(element, quantity), altimeter.readout, quantity);
}

void write_sdf_sensor(XmlNode& model_element, const Model&, const Magnetometer& magnetometer) {
  XmlNode& element = add(add_posed_sensor(model_element, "magnetometer", magnetometer), "magnetometer");
  add_noises(element, magnetometer.readout, "magnetic_field");
}

void write_sdf_sensor(XmlNode& model_element, const Model&, const LogicalCamera& camera) {
  XmlNode& element = add(add_posed_sensor(model_element, "logical_camera", camera), "logical_camera");
  add_value(element, "near", camera.near);
  add_value(element, "far", camera.far);
  add_value(element, "aspect_ratio", camera.aspect_ratio);
  add_value(element, "horizontal_fov", camera.horizontal_fov);
}

void write_sdf_sensor(XmlNode& model_element, const Model&, const AirPressureSensor& sensor) {
  XmlNode& element = add(add_posed_sensor(model_element, "air_pressure", sensor), "air_pressure");
  add_value(element, "reference_altitude", sensor.reference_altitude);
  add_noise(add(element, "pressure"), sensor.readout, "pressure");
}

void write_sdf_sensor(XmlNode& model_element, const Model&, const NavSat& sensor) {
  XmlNode& element = add(add_posed_sensor(model_element, "navsat", sensor), "navsat");
  for (const auto& [sensing, quantity] :
       {std::pair{"position_sensing", "position"}, std::pair{"velocity_sensing", "velocity"}}) {
    XmlNode& each = add(element, sensing);
    add_noise(add(each, "horizontal"), sensor.readout, quantity, 0);
    add_noise(add(each, "vertical"), sensor.readout, quantity, 2);
  }
}

}  // namespace cohort::parsing
