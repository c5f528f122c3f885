#pragma once

#include "idl/messages/ros_schema.hpp"

/// Messages of ROS 2 that recordings hold, with the names, types and order of fields of the release Jazzy. SI units
/// unless said otherwise; x forward, y left, z up.
namespace cohort::messages::ros {

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

/// In seconds and nanoseconds. Times beyond the year 2038, which it cannot hold, become the last one that it can.
Time time(std::chrono::nanoseconds since_epoch);
std::chrono::nanoseconds nanoseconds(const Time& time);

}  // namespace cohort::messages::ros
