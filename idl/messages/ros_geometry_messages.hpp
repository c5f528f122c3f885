// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_std_messages.hpp"

/// Messages of ROS 2's geometry_msgs.
namespace cohort::messages::ros {

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

/// A unit quaternion.
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

/// A velocity: linear [m/s], angular [rad/s].
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

/// A force [N] and a torque [N m].
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

/// An acceleration: linear [m/s^2], angular [rad/s^2].
struct Accel {
  Vector3 linear{};
  Vector3 angular{};
  static constexpr const char* type = "geometry_msgs/msg/Accel";
  static constexpr auto fields = std::tuple(field("linear", &Accel::linear), field("angular", &Accel::angular));
  bool operator==(const Accel&) const = default;
};

/// Covariance of x, y, z and of rotations about x, y, z, row-major [m^2], [rad^2].
struct PoseWithCovariance {
  Pose pose{};
  std::array<double, 36> covariance{};
  static constexpr const char* type = "geometry_msgs/msg/PoseWithCovariance";
  static constexpr auto fields =
      std::tuple(field("pose", &PoseWithCovariance::pose), field("covariance", &PoseWithCovariance::covariance));
  bool operator==(const PoseWithCovariance&) const = default;
};

/// Covariance of the linear and the angular velocity, row-major.
struct TwistWithCovariance {
  Twist twist{};
  std::array<double, 36> covariance{};
  static constexpr const char* type = "geometry_msgs/msg/TwistWithCovariance";
  static constexpr auto fields =
      std::tuple(field("twist", &TwistWithCovariance::twist), field("covariance", &TwistWithCovariance::covariance));
  bool operator==(const TwistWithCovariance&) const = default;
};

}  // namespace cohort::messages::ros
