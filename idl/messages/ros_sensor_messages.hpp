// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_messages.hpp"

/// Messages of ROS 2's sensor_msgs.
namespace cohort::messages::ros {

/// Angles counter-clockwise about z [rad], distances [m], times [s]. A distance is infinite if nothing is in range.
struct LaserScan {
  Header header{};
  float angle_min = 0;
  float angle_max = 0;
  float angle_increment = 0;
  float time_increment = 0;
  float scan_time = 0;
  float range_min = 0;
  float range_max = 0;
  std::vector<float> ranges{};
  std::vector<float> intensities{};
  static constexpr const char* type = "sensor_msgs/msg/LaserScan";
  static constexpr auto fields =
      std::tuple(field("header", &LaserScan::header), field("angle_min", &LaserScan::angle_min),
                 field("angle_max", &LaserScan::angle_max), field("angle_increment", &LaserScan::angle_increment),
                 field("time_increment", &LaserScan::time_increment), field("scan_time", &LaserScan::scan_time),
                 field("range_min", &LaserScan::range_min), field("range_max", &LaserScan::range_max),
                 field("ranges", &LaserScan::ranges), field("intensities", &LaserScan::intensities));
  bool operator==(const LaserScan&) const = default;
};

/// A field of each point: `count` values of type `datatype`, `offset` bytes from the point's start.
struct PointField {
  std::string name{};
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 0;
  static constexpr std::uint8_t float32 = 7;
  static constexpr const char* type = "sensor_msgs/msg/PointField";
  static constexpr auto fields =
      std::tuple(field("name", &PointField::name), field("offset", &PointField::offset),
                 field("datatype", &PointField::datatype), field("count", &PointField::count));
  bool operator==(const PointField&) const = default;
};

/// `height` rows of `width` points of `point_step` bytes.
struct PointCloud2 {
  Header header{};
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::vector<PointField> point_fields{};
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::vector<std::uint8_t> data{};
  bool is_dense = false;
  static constexpr const char* type = "sensor_msgs/msg/PointCloud2";
  static constexpr auto fields = std::tuple(
      field("header", &PointCloud2::header), field("height", &PointCloud2::height), field("width", &PointCloud2::width),
      field("fields", &PointCloud2::point_fields), field("is_bigendian", &PointCloud2::is_bigendian),
      field("point_step", &PointCloud2::point_step), field("row_step", &PointCloud2::row_step),
      field("data", &PointCloud2::data), field("is_dense", &PointCloud2::is_dense));
  bool operator==(const PointCloud2&) const = default;
  /// Sets one row of points; `coordinates` has x, y and z of each point [m].
  void set_points(const std::vector<float>& coordinates);
};

/// Covariances are row-major; -1 as the first number means that the quantity is not measured.
struct Imu {
  Header header{};
  Quaternion orientation{};
  std::array<double, 9> orientation_covariance{};
  Vector3 angular_velocity{};
  std::array<double, 9> angular_velocity_covariance{};
  Vector3 linear_acceleration{};
  std::array<double, 9> linear_acceleration_covariance{};
  static constexpr const char* type = "sensor_msgs/msg/Imu";
  static constexpr auto fields = std::tuple(
      field("header", &Imu::header), field("orientation", &Imu::orientation),
      field("orientation_covariance", &Imu::orientation_covariance), field("angular_velocity", &Imu::angular_velocity),
      field("angular_velocity_covariance", &Imu::angular_velocity_covariance),
      field("linear_acceleration", &Imu::linear_acceleration),
      field("linear_acceleration_covariance", &Imu::linear_acceleration_covariance));
  bool operator==(const Imu&) const = default;
};

/// Magnetic field [T].
struct MagneticField {
  Header header{};
  Vector3 magnetic_field{};
  std::array<double, 9> magnetic_field_covariance{};
  static constexpr const char* type = "sensor_msgs/msg/MagneticField";
  static constexpr auto fields =
      std::tuple(field("header", &MagneticField::header), field("magnetic_field", &MagneticField::magnetic_field),
                 field("magnetic_field_covariance", &MagneticField::magnetic_field_covariance));
  bool operator==(const MagneticField&) const = default;
};

/// Pressure [Pa], variance [Pa^2]; 0: unknown.
struct FluidPressure {
  Header header{};
  double fluid_pressure = 0;
  double variance = 0;
  static constexpr const char* type = "sensor_msgs/msg/FluidPressure";
  static constexpr auto fields =
      std::tuple(field("header", &FluidPressure::header), field("fluid_pressure", &FluidPressure::fluid_pressure),
                 field("variance", &FluidPressure::variance));
  bool operator==(const FluidPressure&) const = default;
};

/// Temperature [degrees Celsius].
struct Temperature {
  Header header{};
  double temperature = 0;
  double variance = 0;
  static constexpr const char* type = "sensor_msgs/msg/Temperature";
  static constexpr auto fields =
      std::tuple(field("header", &Temperature::header), field("temperature", &Temperature::temperature),
                 field("variance", &Temperature::variance));
  bool operator==(const Temperature&) const = default;
};

/// Relative humidity, from 0 to 1.
struct RelativeHumidity {
  Header header{};
  double relative_humidity = 0;
  double variance = 0;
  static constexpr const char* type = "sensor_msgs/msg/RelativeHumidity";
  static constexpr auto fields = std::tuple(field("header", &RelativeHumidity::header),
                                            field("relative_humidity", &RelativeHumidity::relative_humidity),
                                            field("variance", &RelativeHumidity::variance));
  bool operator==(const RelativeHumidity&) const = default;
};

/// Positions [rad] or [m], velocities [rad/s] or [m/s], efforts [N m] or [N]; each list is as long as `name`, or empty.
struct JointState {
  Header header{};
  std::vector<std::string> name{};
  std::vector<double> position{};
  std::vector<double> velocity{};
  std::vector<double> effort{};
  static constexpr const char* type = "sensor_msgs/msg/JointState";
  static constexpr auto fields = std::tuple(
      field("header", &JointState::header), field("name", &JointState::name), field("position", &JointState::position),
      field("velocity", &JointState::velocity), field("effort", &JointState::effort));
  bool operator==(const JointState&) const = default;
};

/// Distances [m], `field_of_view` [rad], variance [m^2]; 0: unknown. In Humble the message has no variance, and readers
/// ignore the additional bytes.
struct Range {
  Header header{};
  std::uint8_t radiation_type = 0;
  float field_of_view = 0;
  float min_range = 0;
  float max_range = 0;
  float range = 0;
  float variance = 0;
  static constexpr std::uint8_t ultrasound = 0;
  static constexpr std::uint8_t infrared = 1;
  static constexpr const char* type = "sensor_msgs/msg/Range";
  static constexpr auto fields = std::tuple(
      field("header", &Range::header), field("radiation_type", &Range::radiation_type),
      field("field_of_view", &Range::field_of_view), field("min_range", &Range::min_range),
      field("max_range", &Range::max_range), field("range", &Range::range), field("variance", &Range::variance));
  bool operator==(const Range&) const = default;
};

/// Voltage [V], temperature [degrees Celsius], current [A] (negative while discharging), charge [A h], percentage from
/// 0 to 1; NaN: not measured.
struct BatteryState {
  Header header{};
  float voltage = 0;
  float temperature = 0;
  float current = 0;
  float charge = 0;
  float capacity = 0;
  float design_capacity = 0;
  float percentage = 0;
  std::uint8_t power_supply_status = 0;
  std::uint8_t power_supply_health = 0;
  std::uint8_t power_supply_technology = 0;
  bool present = false;
  std::vector<float> cell_voltage{};
  std::vector<float> cell_temperature{};
  std::string location{};
  std::string serial_number{};
  static constexpr std::uint8_t discharging = 2;
  static constexpr const char* type = "sensor_msgs/msg/BatteryState";
  static constexpr auto fields = std::tuple(
      field("header", &BatteryState::header), field("voltage", &BatteryState::voltage),
      field("temperature", &BatteryState::temperature), field("current", &BatteryState::current),
      field("charge", &BatteryState::charge), field("capacity", &BatteryState::capacity),
      field("design_capacity", &BatteryState::design_capacity), field("percentage", &BatteryState::percentage),
      field("power_supply_status", &BatteryState::power_supply_status),
      field("power_supply_health", &BatteryState::power_supply_health),
      field("power_supply_technology", &BatteryState::power_supply_technology),
      field("present", &BatteryState::present), field("cell_voltage", &BatteryState::cell_voltage),
      field("cell_temperature", &BatteryState::cell_temperature), field("location", &BatteryState::location),
      field("serial_number", &BatteryState::serial_number));
  bool operator==(const BatteryState&) const = default;
};

/// State of the receiver: `status` is -2 unknown, -1 no fix, 0 fix; `service` is a sum of 1 GPS, 2 GLONASS, 4 BeiDou, 8
/// Galileo.
struct NavSatStatus {
  std::int8_t status = -2;
  std::uint16_t service = 0;
  static constexpr std::int8_t fix = 0;
  static constexpr std::uint16_t gps = 1;
  static constexpr const char* type = "sensor_msgs/msg/NavSatStatus";
  static constexpr auto fields =
      std::tuple(field("status", &NavSatStatus::status), field("service", &NavSatStatus::service));
  bool operator==(const NavSatStatus&) const = default;
};

/// Latitude and longitude [degrees], altitude above the WGS 84 ellipsoid [m], covariance east-north-up [m^2].
struct NavSatFix {
  Header header{};
  NavSatStatus status{};
  double latitude = 0;
  double longitude = 0;
  double altitude = 0;
  std::array<double, 9> position_covariance{};
  std::uint8_t position_covariance_type = 0;
  static constexpr std::uint8_t diagonal_known = 2;
  static constexpr const char* type = "sensor_msgs/msg/NavSatFix";
  static constexpr auto fields =
      std::tuple(field("header", &NavSatFix::header), field("status", &NavSatFix::status),
                 field("latitude", &NavSatFix::latitude), field("longitude", &NavSatFix::longitude),
                 field("altitude", &NavSatFix::altitude), field("position_covariance", &NavSatFix::position_covariance),
                 field("position_covariance_type", &NavSatFix::position_covariance_type));
  bool operator==(const NavSatFix&) const = default;
};

/// Rows of `step` bytes from the top; `encoding` is such as `rgb8`.
struct Image {
  Header header{};
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding{};
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;
  std::vector<std::uint8_t> data{};
  static constexpr const char* type = "sensor_msgs/msg/Image";
  static constexpr auto fields =
      std::tuple(field("header", &Image::header), field("height", &Image::height), field("width", &Image::width),
                 field("encoding", &Image::encoding), field("is_bigendian", &Image::is_bigendian),
                 field("step", &Image::step), field("data", &Image::data));
  bool operator==(const Image&) const = default;
};

}  // namespace cohort::messages::ros
