// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <set>

#include "server/core/text.hpp"
#include "server/parsing/model/read_model.hpp"
#include "server/parsing/model/read_values.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"

namespace cohort::parsing {
namespace {

using Path = std::initializer_list<const char*>;

// A <sensor>. A number that has been reported becomes NaN, which passes every check.
class SensorElement {
 public:
  SensorElement(const SensorPlace& place, const Model& model, std::size_t owner, const ModelReading& reading)
      : sensor_(place.sensor),
        frames_(*place.frames),
        owner_(owner),
        name_(place.prefix + parsing::name_of(*place.sensor)),
        model_(model),
        reading_(reading) {
    check_numbers(element(), report());
    readout_.period = period();
  }

  const Element* element() const { return sensor_; }
  const SdfReport& report() const { return reading_.report; }
  const std::string& name() const { return name_; }
  void rename(std::string name) { name_ = std::move(name); }
  /// Returns the index of the link or joint.
  std::size_t owner() const { return owner_; }
  const Link& link() const { return model_.links[owner_]; }

  Pose pose() const {
    const Element* const written = sensor_->child("pose");
    if (sensor_->parent()->name() != "joint") return resolved_pose(*sensor_, frames_, reading_);
    if (relative_to(*sensor_).empty())
      return written != nullptr ? written_pose(written->node()).value_or(Pose{}) : Pose{};
    report().problem(written, "expected a pose in the frame of the joint");
    return {};
  }
  /// Returns the element at a path; the sensor if there is none.
  const Element* where(Path path) const {
    const Element* const found = find(element(), path);
    return is_written(found) ? found : element();
  }
  double real(Path path, double by_default) const { return number(find(element(), path), by_default); }
  double non_negative(Path path, double by_default) const { return non_negative(find(element(), path), by_default); }
  std::size_t count(Path path, std::size_t by_default) const;
  std::string text(Path path, const std::string& by_default) const {
    const Element* const found = find(element(), path);
    return is_written(found) ? std::string(trimmed(found->text())) : by_default;
  }
  bool flag(Path path, bool by_default) const {
    const Element* const found = find(element(), path);
    return is_written(found) ? found->flag() : by_default;
  }
  void problem(Path path, std::string message) const { report().problem(where(path), std::move(message)); }

  /// Adds the noise at `path` of a quantity, or of one value of it.
  void add_noise(const Element* noise, const std::string& quantity, int value = -1);
  void add_noise(Path path, const std::string& quantity) { add_noise(find(element(), path), quantity); }
  /// Adds the noises below `parent`, one for each axis.
  void add_noises(const Element* parent, const std::string& quantity) {
    int axis = 0;
    for (const char* const each : {"x", "y", "z"}) add_noise(find(parent, {each, "noise"}), quantity, axis++);
  }
  const Readout& readout() const { return readout_; }

 private:
  double number(const Element* found, double by_default) const;
  double non_negative(const Element* found, double by_default) const;
  std::chrono::nanoseconds period() const {
    const double rate = non_negative({"update_rate"}, 0.0);
    return rate > 0.0 ? to_time(1.0 / rate) : std::chrono::nanoseconds(0);
  }

  const Element* sensor_;
  const Frames& frames_;
  std::size_t owner_;
  std::string name_;
  const Model& model_;
  const ModelReading& reading_;
  Readout readout_;
};

double SensorElement::number(const Element* found, double by_default) const {
  constexpr double reported = std::numeric_limits<double>::quiet_NaN();
  if (!is_written(found)) return by_default;
  const double value = parse_real(found->text()).value_or(reported);
  if (std::isnan(value)) return reported;  // by check_numbers
  if (std::isfinite(value)) return value;
  report().problem(found, "expected a finite number");
  return reported;
}

double SensorElement::non_negative(const Element* found, double by_default) const {
  const double value = number(found, by_default);
  if (value < 0.0) report().problem(found, "expected a number >= 0");
  return value;
}

std::size_t SensorElement::count(Path path, std::size_t by_default) const {
  const Element* const found = find(element(), path);
  if (!is_written(found)) return by_default;
  const std::string written = found->text();
  if (const auto value = parse_whole(written); value && *value > 0) return *value;
  if (parse_real(written)) report().problem(found, "expected a whole number >= 1");
  return by_default;
}

void SensorElement::add_noise(const Element* noise, const std::string& quantity, int value) {
  if (!noise) return;
  // The noise of a lidar has its type in an element.
  std::string type = "none";
  if (const Element* const child = noise->child("type"))
    type = trimmed(child->text());
  else if (noise->has_attribute("type"))
    type = trimmed(noise->attribute("type"));
  if (type == "none") return;
  if (type != "gaussian" && type != "gaussian_quantized") {
    report().problem(noise, "expected the noise type none, gaussian or gaussian_quantized, not '" + type + "'");
    return;
  }
  Noise result;
  result.quantity = quantity;
  result.element = value;
  result.mean = number(noise->child("mean"), 0.0);
  result.deviation = non_negative(noise->child("stddev"), 0.0);
  result.bias = number(noise->child("bias_mean"), 0.0);
  result.bias_deviation = non_negative(noise->child("bias_stddev"), 0.0);
  const double density = non_negative(noise->child("dynamic_bias_stddev"), 0.0);
  const double time = non_negative(noise->child("dynamic_bias_correlation_time"), 0.0);
  if (density > 0.0 && time > 0.0) {
    result.drift_deviation = density * drift_from_density(time);
    result.drift_time = time;
  }
  if (type == "gaussian_quantized") result.precision = non_negative(noise->child("precision"), 0.0);
  if (!is_exact(result)) readout_.noises.push_back(result);
}

// Returns a sensor with a pose on a link; each kind adds its own values.
template <class Sensor>
Sensor posed(const SensorElement& element) {
  Sensor sensor;
  sensor.name = element.name();
  sensor.link = element.owner();
  sensor.X_LS = element.pose();
  return sensor;
}

// Maximum number of rays of a sensor.
constexpr std::size_t most_rays = 100'000;

// Reads the number of rays in one direction of a scan.
std::size_t read_rays(const SensorElement& sensor, const char* kind, const char* direction, std::size_t by_default) {
  const std::size_t samples = sensor.count({kind, "scan", direction, "samples"}, by_default);
  const double resolution = sensor.real({kind, "scan", direction, "resolution"}, 1.0);
  const double rays = std::round(static_cast<double>(samples) * resolution);
  if (rays >= 1.0 && rays <= static_cast<double>(most_rays)) return static_cast<std::size_t>(rays);
  if (std::isnan(rays)) return 1;
  sensor.problem({kind, "scan", direction, "samples"},
                 "expected 1 to " + std::to_string(most_rays) + " rays (samples times resolution)");
  return 1;
}

void read_angles(const SensorElement& sensor, const char* kind, const char* direction, double& least,
                 double& greatest) {
  least = sensor.real({kind, "scan", direction, "min_angle"}, 0.0);
  greatest = sensor.real({kind, "scan", direction, "max_angle"}, 0.0);
  if (least > greatest) sensor.problem({kind, "scan", direction, "min_angle"}, "the minimum angle exceeds the maximum");
}

std::optional<Device> read_lidar(SensorElement& sensor) {
  const char* const kind = sensor.element()->child("ray") ? "ray" : "lidar";
  auto lidar = posed<Lidar>(sensor);
  lidar.columns = read_rays(sensor, kind, "horizontal", 640);
  lidar.rows = read_rays(sensor, kind, "vertical", 1);
  if (lidar.columns * lidar.rows > most_rays)
    sensor.problem({kind, "scan", "vertical", "samples"}, "expected at most " + std::to_string(most_rays) + " rays");
  read_angles(sensor, kind, "horizontal", lidar.min_bearing, lidar.max_bearing);
  read_angles(sensor, kind, "vertical", lidar.min_elevation, lidar.max_elevation);
  lidar.min_range = sensor.non_negative({kind, "range", "min"}, 0.0);
  lidar.max_range = sensor.non_negative({kind, "range", "max"}, 0.0);
  if (lidar.max_range <= lidar.min_range)
    sensor.problem({kind, "range", "max"}, "expected a <range> with a <max> > <min>");
  sensor.add_noise({kind, "noise"}, "ranges");
  return lidar;
}

void read_reference(const SensorElement& sensor, Imu& imu) {
  const auto ignored = [&](Path path, const std::string& what) {
    sensor.report().warning(sensor.where(path),
                            what + " is not supported; the orientation is relative to the initial orientation");
  };
  const std::string localization = sensor.text({"imu", "orientation_reference_frame", "localization"}, "CUSTOM");
  if (localization == "ENU") {  // SDF's world frame
    imu.is_relative_to_world = true;
    return;
  }
  if (localization != "CUSTOM")
    return ignored({"imu", "orientation_reference_frame", "localization"}, "the localization '" + localization + "'");
  const Element* const rpy = find(sensor.element(), {"imu", "orientation_reference_frame", "custom_rpy"});
  if (!rpy) return;
  const auto frame = rpy->attribute("parent_frame");
  if (!frame.empty() && frame != "world")
    return ignored({"imu", "orientation_reference_frame", "custom_rpy"}, "the parent_frame '" + frame + "'");
  imu.is_relative_to_world = frame == "world";
  if (is_written(rpy)) imu.reference_rpy = rpy->vector();
}

std::optional<Device> read_imu(SensorElement& sensor) {
  auto imu = posed<Imu>(sensor);
  imu.has_orientation = sensor.flag({"imu", "enable_orientation"}, true);
  read_reference(sensor, imu);
  for (const char* const quantity : {"angular_velocity", "linear_acceleration"})
    sensor.add_noises(find(sensor.element(), {"imu", quantity}), quantity);
  return imu;
}

std::optional<Device> read_contact(SensorElement& sensor) {
  const std::string name = sensor.text({"contact", "collision"}, "");
  if (name.empty()) {
    sensor.report().problem(sensor.element(), "missing: <contact><collision>, the name of a collision of the link");
    return std::nullopt;
  }
  const std::vector<Collision>& collisions = sensor.link().collisions;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < collisions.size(); ++i) {
    if (collisions[i].name == name) return ContactSensor{sensor.name(), sensor.owner(), i};
    names.push_back(collisions[i].name);
  }
  sensor.problem({"contact", "collision"}, "the link has no collision '" + name + "'" + suggestion(name, names));
  return std::nullopt;
}

std::optional<Device> read_force_torque(SensorElement& sensor) {
  ForceTorqueSensor result;
  result.name = sensor.name();
  result.joint = sensor.owner();
  result.X_JS = sensor.pose();
  const std::string frame = sensor.text({"force_torque", "frame"}, "child");
  if (frame == "parent")
    result.axes = ForceTorqueSensor::Frame::parent;
  else if (frame == "sensor")
    result.axes = ForceTorqueSensor::Frame::sensor;
  else if (frame != "child")
    sensor.problem({"force_torque", "frame"}, "expected parent, child or sensor, not '" + frame + "'");
  const std::string direction = sensor.text({"force_torque", "measure_direction"}, "child_to_parent");
  result.is_on_parent = direction == "child_to_parent";
  if (!result.is_on_parent && direction != "parent_to_child")
    sensor.problem({"force_torque", "measure_direction"},
                   "expected parent_to_child or child_to_parent, not '" + direction + "'");
  for (const char* const quantity : {"force", "torque"})
    sensor.add_noises(find(sensor.element(), {"force_torque", quantity}), quantity);
  return result;
}

std::optional<Device> read_altimeter(SensorElement& sensor) {
  sensor.add_noise({"altimeter", "vertical_position", "noise"}, "vertical_position");
  sensor.add_noise({"altimeter", "vertical_velocity", "noise"}, "vertical_velocity");
  return posed<Altimeter>(sensor);
}

std::optional<Device> read_magnetometer(SensorElement& sensor) {
  sensor.add_noises(find(sensor.element(), {"magnetometer"}), "magnetic_field");
  return posed<Magnetometer>(sensor);
}

std::optional<Device> read_logical_camera(SensorElement& sensor) {
  auto camera = posed<LogicalCamera>(sensor);
  camera.near = sensor.non_negative({"logical_camera", "near"}, 0.0);
  camera.far = sensor.real({"logical_camera", "far"}, 1.0);
  camera.horizontal_fov = sensor.real({"logical_camera", "horizontal_fov"}, 1.0);
  camera.aspect_ratio = sensor.real({"logical_camera", "aspect_ratio"}, 1.0);
  if (camera.far <= camera.near) sensor.problem({"logical_camera", "far"}, "expected a distance > <near>");
  if (camera.horizontal_fov <= 0.0 || camera.horizontal_fov >= std::numbers::pi)
    sensor.problem({"logical_camera", "horizontal_fov"}, "expected an angle > 0 and < pi");
  if (camera.aspect_ratio <= 0.0) sensor.problem({"logical_camera", "aspect_ratio"}, "expected a number > 0");
  return camera;
}

std::optional<Device> read_air_pressure(SensorElement& sensor) {
  auto result = posed<AirPressureSensor>(sensor);
  result.reference_altitude = sensor.real({"air_pressure", "reference_altitude"}, 0.0);
  sensor.add_noise({"air_pressure", "pressure", "noise"}, "pressure");
  return result;
}

std::optional<Device> read_navsat(SensorElement& sensor) {
  // As in SDF, both types `navsat` and `gps` can use either name for the child element.
  const char* const element = find(sensor.element(), {"gps"}) ? "gps" : "navsat";
  for (const auto& [sensing, quantity] :
       {std::pair{"position_sensing", "position"}, std::pair{"velocity_sensing", "velocity"}}) {
    const Element* const horizontal = find(sensor.element(), {element, sensing, "horizontal", "noise"});
    for (const int axis : {0, 1}) sensor.add_noise(horizontal, quantity, axis);
    sensor.add_noise(find(sensor.element(), {element, sensing, "vertical", "noise"}), quantity, 2);
  }
  return posed<NavSat>(sensor);
}

struct Kind {
  std::string_view type;
  std::string_view parent;
  std::optional<Device> (*read)(SensorElement& sensor);
};

// All supported types of SDF sensors: add a new type here.
constexpr Kind kinds[] = {
    {"lidar", "link", &read_lidar},
    {"gpu_lidar", "link", &read_lidar},
    {"ray", "link", &read_lidar},
    {"gpu_ray", "link", &read_lidar},
    {"imu", "link", &read_imu},
    {"contact", "link", &read_contact},
    {"force_torque", "joint", &read_force_torque},
    {"altimeter", "link", &read_altimeter},
    {"magnetometer", "link", &read_magnetometer},
    {"logical_camera", "link", &read_logical_camera},
    {"air_pressure", "link", &read_air_pressure},
    {"navsat", "link", &read_navsat},
    {"gps", "link", &read_navsat},
};

const Kind* kind_of(const Element* element) {
  if (!element || !element->parent()) return nullptr;
  const auto type = element->attribute("type");
  const auto found = std::ranges::find_if(
      kinds, [&](const Kind& kind) { return kind.type == type && kind.parent == element->parent()->name(); });
  return found == std::end(kinds) ? nullptr : found;
}

template <class Named>
std::size_t place_of(const std::vector<Named>& all, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(all, name, &Named::name) - all.begin());
}

}  // namespace

bool is_sensor(const Element* element) { return kind_of(element) != nullptr; }

std::vector<Device> read_sdf_sensors(const std::vector<SensorPlace>& places, const Model& model,
                                     const ModelReading& reading) {
  struct Found {
    const SensorPlace* place;
    std::size_t owner;
  };
  std::vector<Found> found;
  found.reserve(places.size());
  for (const SensorPlace& place : places)
    found.push_back(
        {&place, place.is_on_joint ? place_of(model.joints, place.owner) : place_of(model.links, place.owner)});
  std::ranges::stable_sort(found, {}, [](const Found& each) { return std::pair(each.place->is_on_joint, each.owner); });

  std::set<std::string> names;  // names of devices with observations
  for (const Device& device : model.devices)
    if (readout_of(device) != nullptr) names.insert(name_of(device));
  std::vector<Device> sensors;
  for (const auto& [place, owner] : found) {
    SensorElement sensor(*place, model, owner, reading);
    // A slash separates the parts of the names of channels.
    std::string plain = sensor.name();
    std::ranges::replace(plain, '/', '_');
    if (plain != sensor.name() && reading.report.flaw(sensor.element(), "expected a name without '/'",
                                                      "the sensor is renamed to '" + plain + "'"))
      sensor.rename(plain);
    if (!names.insert(sensor.name()).second) {
      std::string other = place->owner + "_" + sensor.name();
      while (names.contains(other)) other += "_";
      if (reading.report.flaw(sensor.element(), "another device of the model has the name '" + sensor.name() + "'",
                              "the sensor is renamed to '" + other + "'")) {
        sensor.rename(other);
        names.insert(other);
      }
    }
    const std::size_t before = reading.report.count();
    std::optional<Device> device = kind_of(sensor.element())->read(sensor);
    if (device) *readout_of(*device) = sensor.readout();
    if (reading.report.forgive(sensor.element(), before, "the sensor is ignored") || !device) continue;
    sensors.push_back(*std::move(device));
  }
  return sensors;
}

}  // namespace cohort::parsing
