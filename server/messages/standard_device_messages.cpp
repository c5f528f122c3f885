// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "idl/messages/cohort_device_messages.hpp"
#include "server/messages/device_message_list.hpp"

/// Devices with messages in ROS.
namespace cohort::messages {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr double zero_celsius = 273.15;  // [K]

ros::Vector3 vector_at(Values values, std::size_t at) { return {values[at], values[at + 1], values[at + 2]}; }

std::array<double, 9> not_measured() { return {-1.0}; }

// Returns the covariance of a vector whose elements have independent errors.
std::array<double, 9> covariance_of(const description::Readout& readout, const std::string& quantity) {
  std::array<double, 9> covariance{};
  for (std::uint32_t i = 0; i < 3; ++i) covariance[std::size_t{4} * i] = variance_of(readout, quantity, i);
  return covariance;
}

template <class Sensor>
PlaceOnLink place_of(const Sensor& sensor) {
  return {sensor.link, sensor.X_LS};
}

double bearing(const description::Lidar& lidar, std::size_t column) {
  if (lidar.columns == 1) return 0.5 * (lidar.min_bearing + lidar.max_bearing);
  return lidar.min_bearing +
         static_cast<double>(column) * (lidar.max_bearing - lidar.min_bearing) / static_cast<double>(lidar.columns - 1);
}
double elevation(const description::Lidar& lidar, std::size_t row) {
  return lidar.min_elevation +
         static_cast<double>(row) * (lidar.max_elevation - lidar.min_elevation) / static_cast<double>(lidar.rows - 1);
}

// Returns the range of a reading as in ROS (REP 117): -infinity if the object is too near, and infinity if nothing is
// in range. The reading is then at a bound of its channel.
double range_of(const description::Lidar& lidar, double reading) {
  if (reading <= lidar.min_range) return -std::numeric_limits<double>::infinity();
  return reading < lidar.max_range ? reading : std::numeric_limits<double>::infinity();
}

void fill(ros::LaserScan& scan, const description::Lidar& lidar, Values ranges) {
  scan.angle_min = static_cast<float>(bearing(lidar, 0));
  scan.angle_max = static_cast<float>(bearing(lidar, lidar.columns - 1));
  scan.angle_increment =
      lidar.columns == 1 ? 0.0F : (scan.angle_max - scan.angle_min) / static_cast<float>(lidar.columns - 1);
  scan.range_min = static_cast<float>(lidar.min_range);
  scan.range_max = static_cast<float>(lidar.max_range);
  scan.ranges.reserve(lidar.columns);
  for (const double reading : ranges.first(lidar.columns))
    scan.ranges.push_back(static_cast<float>(range_of(lidar, reading)));
}

// Writes the points whose distance was measured, in S.
void fill(ros::PointCloud2& cloud, const description::Lidar& lidar, Values ranges) {
  std::vector<float> points;
  points.reserve(3 * lidar.rows * lidar.columns);
  for (std::size_t row = 0; row < lidar.rows; ++row) {
    const double up = elevation(lidar, row);
    for (std::size_t column = 0; column < lidar.columns; ++column) {
      const double range = range_of(lidar, ranges[row * lidar.columns + column]);
      if (!std::isfinite(range)) continue;
      const double aside = bearing(lidar, column);
      const double level = range * std::cos(up);
      for (const double coordinate : {level * std::cos(aside), level * std::sin(aside), range * std::sin(up)})
        points.push_back(static_cast<float>(coordinate));
    }
  }
  cloud.set_points(points);
}

// Returns the pose of a joint's origin, in the axes of its parent.
Pose place_in_parent(const description::Joint& joint, const LinkPoses& X_WL) {
  Pose X_WS = X_WL(joint.child) * joint.X_LJ;
  X_WS.orientation =
      joint.parent == description::Joint::world ? Eigen::Quaterniond::Identity() : X_WL(joint.parent).orientation;
  return X_WS;
}

// Returns true for a sensor whose reading falls linearly from 1 at contact to 0 at `reach`, or if nothing is in range.
template <class Sensors>
void add_range(DeviceMessageList& list, const Sensors& sensors, std::size_t index, double cone,
               const PlaceOnLink& place) {
  const std::size_t at = list.offset(sensors.name + "/" + std::to_string(index) + "/reading");
  const std::string frame = sensors.name + "_" + std::to_string(index);
  const double reach = sensors.range;
  const auto variance = static_cast<float>(reach * reach * variance_of(sensors.readout, "reading"));
  list.add_placed<ros::Range>(sensors, {"range", frame, DeviceTopic::Naming::never}, place,
                              [=](ros::Range& message, Values values) {
                                message.radiation_type = ros::Range::infrared;
                                message.field_of_view = static_cast<float>(cone);
                                message.max_range = static_cast<float>(reach);
                                message.variance = variance;
                                message.range =
                                    values[at] > 0.0 ? static_cast<float>((1.0 - values[at]) * reach) : infinite;
                              })
      .frame = frame;
}

Pose turned(const Eigen::Vector3d& position, double angle, const Eigen::Vector3d& axis) {
  return {position, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis))};
}

// Moves a position along the WGS 84 ellipsoid, by its radii of curvature there; accurate to centimetres within some
// kilometres.
GeodeticPlace moved(const GeodeticPlace& origin, const ros::Vector3& east_north_up) {
  constexpr double semi_major_axis = 6378137.0;              // [m]
  constexpr double squared_eccentricity = 6.69437999014e-3;  // [1]
  constexpr double degrees = 180.0 / std::numbers::pi;
  const double latitude = origin.latitude / degrees;
  const double w = 1.0 - squared_eccentricity * std::sin(latitude) * std::sin(latitude);
  const double across = semi_major_axis / std::sqrt(w) + origin.altitude;
  const double along = semi_major_axis * (1.0 - squared_eccentricity) / (w * std::sqrt(w)) + origin.altitude;
  return {origin.latitude + degrees * east_north_up.y / along,
          origin.longitude + degrees * east_north_up.x / (across * std::cos(latitude)),
          origin.altitude + east_north_up.z};
}

}  // namespace

void add_messages(DeviceMessageList& list, const description::Lidar& lidar) {
  const std::size_t at = list.offset(lidar.name + "/0/ranges");
  if (lidar.rows == 1)
    list.add_placed<ros::LaserScan>(lidar, {"scan"}, place_of(lidar), [lidar, at](ros::LaserScan& scan, Values values) {
      fill(scan, lidar, values.subspan(at));
    });
  else
    list.add_placed<ros::PointCloud2>(
        lidar, {"points"}, place_of(lidar),
        [lidar, at](ros::PointCloud2& cloud, Values values) { fill(cloud, lidar, values.subspan(at)); });
}

void add_messages(DeviceMessageList& list, const description::Imu& imu) {
  const std::size_t orientation = imu.has_orientation ? list.offset(imu.name + "/0/orientation") : 0;
  const std::size_t velocity = list.offset(imu.name + "/0/angular_velocity");
  const std::size_t acceleration = list.offset(imu.name + "/0/linear_acceleration");
  const auto of_velocity = covariance_of(imu.readout, "angular_velocity");
  const auto of_acceleration = covariance_of(imu.readout, "linear_acceleration");
  list.add_placed<ros::Imu>(imu, {"imu"}, place_of(imu), [=, has = imu.has_orientation](ros::Imu& message, Values v) {
    if (has)
      message.orientation = {v[orientation], v[orientation + 1], v[orientation + 2], v[orientation + 3]};
    else
      message.orientation_covariance = not_measured();
    message.angular_velocity_covariance = of_velocity;
    message.linear_acceleration_covariance = of_acceleration;
    message.angular_velocity = vector_at(v, velocity);
    message.linear_acceleration = vector_at(v, acceleration);
  });
}

void add_messages(DeviceMessageList& list, const description::Accelerometer& sensor) {
  const std::size_t at = list.offset(sensor.name + "/0/acceleration");
  const auto covariance = covariance_of(sensor.readout, "acceleration");
  list.add_placed<ros::Imu>(sensor, {"accelerometer"}, place_of(sensor), [=](ros::Imu& message, Values values) {
    message.orientation_covariance = message.angular_velocity_covariance = not_measured();
    message.linear_acceleration_covariance = covariance;
    message.linear_acceleration = vector_at(values, at);
  });
}

void add_messages(DeviceMessageList& list, const description::Magnetometer& sensor) {
  const std::size_t at = list.offset(sensor.name + "/0/magnetic_field");
  const auto covariance = covariance_of(sensor.readout, "magnetic_field");
  list.add_placed<ros::MagneticField>(sensor, {"magnetic_field"}, place_of(sensor),
                                      [=](ros::MagneticField& message, Values values) {
                                        message.magnetic_field = vector_at(values, at);
                                        message.magnetic_field_covariance = covariance;
                                      });
}

void add_messages(DeviceMessageList& list, const description::AirPressureSensor& sensor) {
  const std::size_t at = list.offset(sensor.name + "/0/pressure");
  const double variance = variance_of(sensor.readout, "pressure");
  list.add_placed<ros::FluidPressure>(sensor, {"fluid_pressure"}, place_of(sensor),
                                      [=](ros::FluidPressure& message, Values values) {
                                        message.fluid_pressure = values[at];
                                        message.variance = variance;
                                      });
}

void add_messages(DeviceMessageList& list, const description::ForceTorqueSensor& sensor) {
  using Frame = description::ForceTorqueSensor::Frame;
  const std::size_t force = list.offset(sensor.name + "/0/force");
  const std::size_t torque = list.offset(sensor.name + "/0/torque");
  DeviceMessage& message = list.add<ros::WrenchStamped>(
      sensor, {"wrench", "", DeviceTopic::Naming::always}, [=](ros::WrenchStamped& wrench, Values values) {
        wrench.wrench = {vector_at(values, force), vector_at(values, torque)};
      });
  const description::Joint joint = list.model().joints[sensor.joint];
  if (sensor.axes == Frame::parent) {
    message.place = [joint](const LinkPoses& X_WL) { return place_in_parent(joint, X_WL); };
    return;
  }
  Pose X_LS = joint.X_LJ;
  X_LS.orientation =
      sensor.axes == Frame::sensor ? (joint.X_LJ * sensor.X_JS).orientation : Eigen::Quaterniond::Identity();
  DeviceMessageList::set_place(message, {joint.child, X_LS});
}

void add_messages(DeviceMessageList& list, const description::ClimateSensor& sensor) {
  const std::size_t temperature = list.offset(sensor.name + "/0/temperature");
  const std::size_t humidity = list.offset(sensor.name + "/0/humidity");
  const PlaceOnLink place{sensor.link, {sensor.p_LS, Eigen::Quaterniond::Identity()}};
  const double of_temperature = variance_of(sensor.readout, "temperature");
  const double of_humidity = variance_of(sensor.readout, "humidity");
  list.add_placed<ros::Temperature>(sensor, {"temperature"}, place, [=](ros::Temperature& message, Values values) {
    message.temperature = values[temperature] - zero_celsius;
    message.variance = of_temperature;
  });
  list.add_placed<ros::RelativeHumidity>(sensor, {"relative_humidity"}, place,
                                         [=](ros::RelativeHumidity& message, Values values) {
                                           message.relative_humidity = values[humidity];
                                           message.variance = of_humidity;
                                         });
}

void add_messages(DeviceMessageList& list, const description::Battery& battery) {
  const std::size_t at = list.offset(battery.name + "/0/charge");
  list.add<ros::BatteryState>(battery, {"battery_state"}, [at](ros::BatteryState& message, Values values) {
    message.voltage = message.temperature = message.current = unknown;
    message.charge = message.capacity = message.design_capacity = unknown;
    message.percentage = static_cast<float>(values[at]);
    message.power_supply_status = ros::BatteryState::discharging;
    message.present = true;
  });
}

void add_messages(DeviceMessageList& list, const description::NavSat& receiver) {
  const std::size_t position = list.offset(receiver.name + "/0/position");
  const std::size_t velocity = list.offset(receiver.name + "/0/velocity");
  list.add_placed<cohort_msgs::LocalFix>(
      receiver, {"navsat"}, place_of(receiver), [=](cohort_msgs::LocalFix& message, Values values) {
        message.position = {values[position], values[position + 1], values[position + 2]};
        message.velocity = vector_at(values, velocity);
      });
  if (!list.origin()) return;
  const auto covariance = covariance_of(receiver.readout, "position");
  list.add_placed<ros::NavSatFix>(receiver, {"fix"}, place_of(receiver),
                                  [=, origin = *list.origin()](ros::NavSatFix& message, Values values) {
                                    const GeodeticPlace here = moved(origin, vector_at(values, position));
                                    message.status = {ros::NavSatStatus::fix, ros::NavSatStatus::gps};
                                    message.latitude = here.latitude;
                                    message.longitude = here.longitude;
                                    message.altitude = here.altitude;
                                    message.position_covariance = covariance;
                                    message.position_covariance_type = ros::NavSatFix::diagonal_known;
                                  });
}

void add_messages(DeviceMessageList& list, const description::PanoramicCamera& camera) {
  const std::size_t at = list.offset(camera.name + "/0/image");
  const auto width = static_cast<std::uint32_t>(camera.width);
  const auto height = static_cast<std::uint32_t>(camera.height);
  list.add_placed<ros::Image>(camera, {"image"}, place_of(camera), [=](ros::Image& image, Values values) {
    image.width = width;
    image.height = height;
    image.encoding = "rgb8";
    image.step = 3 * width;
    image.data.reserve(std::size_t{image.step} * height);
    for (const double share : values.subspan(at, std::size_t{image.step} * height))
      image.data.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0))));
  });
}

void add_messages(DeviceMessageList& list, const description::ProximityRing& ring) {
  if (ring.technique == description::ProximityTechnique::samples) return add_ring_readings(list, ring);
  for (std::size_t i = 0; i < ring.count; ++i) {
    const double angle = ring.first_bearing + static_cast<double>(i) * ring.spacing;
    const Eigen::Vector3d place_S(ring.ring_radius * std::cos(angle), ring.ring_radius * std::sin(angle), 0.0);
    add_range(list, ring, i, ring.cone, {ring.link, ring.X_LS * turned(place_S, angle, Eigen::Vector3d::UnitZ())});
  }
}

// The x axes of ground sensors point down.
void add_messages(DeviceMessageList& list, const description::GroundSensors& sensors) {
  for (std::size_t i = 0; i < sensors.places_L.size(); ++i)
    add_range(list, sensors, i, 0.0,
              {sensors.link, turned(sensors.places_L[i], 0.5 * std::numbers::pi, Eigen::Vector3d::UnitY())});
}

void add_joint_states(DeviceMessageList& list) {
  struct Encoder {
    std::string joint;
    std::size_t position, velocity;
  };
  struct Encoders {
    std::string name{};
    description::Readout readout{};
  } all;
  std::vector<Encoder> encoders;
  std::vector<std::string> devices;
  for (const description::Device& device : list.model().devices) {
    const auto* const encoder = std::get_if<description::JointEncoder>(&device);
    if (encoder == nullptr) continue;
    const std::string& joint = list.model().joints[encoder->joint].name;
    if (std::ranges::find(encoders, joint, &Encoder::joint) != encoders.end())
      continue;  // the first one if there are two
    const std::chrono::nanoseconds period = encoder->readout.period;
    all.readout.period = encoders.empty() ? period : std::min(all.readout.period, period);
    devices.push_back(encoder->name);
    encoders.push_back({joint, list.offset(encoder->name + "/0/position"), list.offset(encoder->name + "/0/velocity")});
  }
  if (encoders.empty()) return;
  const auto fill_in = [encoders](ros::JointState& state, Values values) {
    for (const Encoder& encoder : encoders) {
      state.name.push_back(encoder.joint);
      state.position.push_back(values[encoder.position]);
      state.velocity.push_back(values[encoder.velocity]);
    }
  };
  list.add<ros::JointState>(all, {"joint_states"}, fill_in).devices = std::move(devices);
}

}  // namespace cohort::messages
