#pragma once

#include "server/recording/ros_schema.hpp"

/// Messages of ROS 2 that recordings hold, with the names, types and order of fields of the release Jazzy. SI units
/// unless said otherwise; x forward, y left, z up.
namespace cohort::recording::ros {

/// Seconds and nanoseconds, at least 0 and below 10^9.
struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  static constexpr const char* type = "builtin_interfaces/msg/Time";
  static constexpr auto fields = std::tuple(field("sec", &Time::sec), field("nanosec", &Time::nanosec));
  bool operator==(const Time&) const = default;
};

struct Header {
  Time stamp{};
  std::string frame_id{};
  static constexpr const char* type = "std_msgs/msg/Header";
  static constexpr auto fields = std::tuple(field("stamp", &Header::stamp), field("frame_id", &Header::frame_id));
  bool operator==(const Header&) const = default;
};

struct MultiArrayDimension {
  std::string label{};
  std::uint32_t size = 0;
  std::uint32_t stride = 0;
  static constexpr const char* type = "std_msgs/msg/MultiArrayDimension";
  static constexpr auto fields =
      std::tuple(field("label", &MultiArrayDimension::label), field("size", &MultiArrayDimension::size),
                 field("stride", &MultiArrayDimension::stride));
  bool operator==(const MultiArrayDimension&) const = default;
};

struct MultiArrayLayout {
  std::vector<MultiArrayDimension> dim{};
  std::uint32_t data_offset = 0;
  static constexpr const char* type = "std_msgs/msg/MultiArrayLayout";
  static constexpr auto fields =
      std::tuple(field("dim", &MultiArrayLayout::dim), field("data_offset", &MultiArrayLayout::data_offset));
  bool operator==(const MultiArrayLayout&) const = default;
};

struct Float64MultiArray {
  MultiArrayLayout layout{};
  std::vector<double> data{};
  static constexpr const char* type = "std_msgs/msg/Float64MultiArray";
  static constexpr auto fields =
      std::tuple(field("layout", &Float64MultiArray::layout), field("data", &Float64MultiArray::data));
  bool operator==(const Float64MultiArray&) const = default;
};

struct Clock {
  Time clock{};
  static constexpr const char* type = "rosgraph_msgs/msg/Clock";
  static constexpr auto fields = std::tuple(field("clock", &Clock::clock));
  bool operator==(const Clock&) const = default;
};

struct Point {
  double x = 0;
  double y = 0;
  double z = 0;
  static constexpr const char* type = "geometry_msgs/msg/Point";
  static constexpr auto fields = std::tuple(field("x", &Point::x), field("y", &Point::y), field("z", &Point::z));
  bool operator==(const Point&) const = default;
};

struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;
  static constexpr const char* type = "geometry_msgs/msg/Vector3";
  static constexpr auto fields = std::tuple(field("x", &Vector3::x), field("y", &Vector3::y), field("z", &Vector3::z));
  bool operator==(const Vector3&) const = default;
};

/// Of length 1.
struct Quaternion {
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 1;
  static constexpr const char* type = "geometry_msgs/msg/Quaternion";
  static constexpr auto fields = std::tuple(field("x", &Quaternion::x), field("y", &Quaternion::y),
                                            field("z", &Quaternion::z), field("w", &Quaternion::w));
  bool operator==(const Quaternion&) const = default;
};

struct Pose {
  Point position{};
  Quaternion orientation{};
  static constexpr const char* type = "geometry_msgs/msg/Pose";
  static constexpr auto fields =
      std::tuple(field("position", &Pose::position), field("orientation", &Pose::orientation));
  bool operator==(const Pose&) const = default;
};

struct PoseStamped {
  Header header{};
  Pose pose{};
  static constexpr const char* type = "geometry_msgs/msg/PoseStamped";
  static constexpr auto fields = std::tuple(field("header", &PoseStamped::header), field("pose", &PoseStamped::pose));
  bool operator==(const PoseStamped&) const = default;
};

struct PoseArray {
  Header header{};
  std::vector<Pose> poses{};
  static constexpr const char* type = "geometry_msgs/msg/PoseArray";
  static constexpr auto fields = std::tuple(field("header", &PoseArray::header), field("poses", &PoseArray::poses));
  bool operator==(const PoseArray&) const = default;
};

struct Transform {
  Vector3 translation{};
  Quaternion rotation{};
  static constexpr const char* type = "geometry_msgs/msg/Transform";
  static constexpr auto fields =
      std::tuple(field("translation", &Transform::translation), field("rotation", &Transform::rotation));
  bool operator==(const Transform&) const = default;
};

struct TransformStamped {
  Header header{};
  std::string child_frame_id{};
  Transform transform{};
  static constexpr const char* type = "geometry_msgs/msg/TransformStamped";
  static constexpr auto fields =
      std::tuple(field("header", &TransformStamped::header), field("child_frame_id", &TransformStamped::child_frame_id),
                 field("transform", &TransformStamped::transform));
  bool operator==(const TransformStamped&) const = default;
};

/// [m/s], [rad/s].
struct Twist {
  Vector3 linear{};
  Vector3 angular{};
  static constexpr const char* type = "geometry_msgs/msg/Twist";
  static constexpr auto fields = std::tuple(field("linear", &Twist::linear), field("angular", &Twist::angular));
  bool operator==(const Twist&) const = default;
};

struct TwistStamped {
  Header header{};
  Twist twist{};
  static constexpr const char* type = "geometry_msgs/msg/TwistStamped";
  static constexpr auto fields =
      std::tuple(field("header", &TwistStamped::header), field("twist", &TwistStamped::twist));
  bool operator==(const TwistStamped&) const = default;
};

/// [N], [Nm].
struct Wrench {
  Vector3 force{};
  Vector3 torque{};
  static constexpr const char* type = "geometry_msgs/msg/Wrench";
  static constexpr auto fields = std::tuple(field("force", &Wrench::force), field("torque", &Wrench::torque));
  bool operator==(const Wrench&) const = default;
};

struct WrenchStamped {
  Header header{};
  Wrench wrench{};
  static constexpr const char* type = "geometry_msgs/msg/WrenchStamped";
  static constexpr auto fields =
      std::tuple(field("header", &WrenchStamped::header), field("wrench", &WrenchStamped::wrench));
  bool operator==(const WrenchStamped&) const = default;
};

struct TFMessage {
  std::vector<TransformStamped> transforms{};
  static constexpr const char* type = "tf2_msgs/msg/TFMessage";
  static constexpr auto fields = std::tuple(field("transforms", &TFMessage::transforms));
  bool operator==(const TFMessage&) const = default;
};

/// Angles counter-clockwise about z [rad], distances [m], times [s]. Nothing within reach: infinite.
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

/// A number of each point: `offset` bytes from its beginning, `count` of `datatype`.
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
  /// One row of points x, y, z [m], three numbers each.
  void set_points(const std::vector<float>& coordinates);
};

/// Covariances row by row; -1 as the first number: this quantity is not measured.
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

/// [T].
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

/// [Pa], variance [Pa^2]; 0: unknown.
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

/// [degrees Celsius].
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

/// 0 to 1.
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

/// [rad] or [m], [rad/s] or [m/s], [Nm] or [N]; each list as long as `name`, or empty.
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

/// Distances [m], `field_of_view` [rad], variance [m^2], 0: unknown.
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

/// [V], [degrees Celsius], [A] (negative while discharging), [Ah], percentage 0 to 1; NaN: not measured.
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

/// Of the receiver: `status` -2 unknown, -1 no fix, 0 fix; `service` a sum of 1 GPS, 2 GLONASS, 4 BeiDou, 8 Galileo.
struct NavSatStatus {
  std::int8_t status = -2;
  std::uint16_t service = 0;
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
  static constexpr const char* type = "sensor_msgs/msg/NavSatFix";
  static constexpr auto fields =
      std::tuple(field("header", &NavSatFix::header), field("status", &NavSatFix::status),
                 field("latitude", &NavSatFix::latitude), field("longitude", &NavSatFix::longitude),
                 field("altitude", &NavSatFix::altitude), field("position_covariance", &NavSatFix::position_covariance),
                 field("position_covariance_type", &NavSatFix::position_covariance_type));
  bool operator==(const NavSatFix&) const = default;
};
/// In seconds and nanoseconds. Times beyond the year 2038, which it cannot hold, become the last one that it can.
Time time(std::chrono::nanoseconds since_epoch);
std::chrono::nanoseconds nanoseconds(const Time& time);

}  // namespace cohort::recording::ros
