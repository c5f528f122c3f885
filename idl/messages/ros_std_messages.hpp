// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_schema.hpp"

/// Messages of ROS 2's builtin_interfaces and std_msgs.
namespace cohort::messages::ros {

/// Seconds, and nanoseconds from 0 to below 10^9.
struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  static constexpr const char* type = "builtin_interfaces/msg/Time";
  static constexpr auto fields = std::tuple(field("sec", &Time::sec), field("nanosec", &Time::nanosec));
  bool operator==(const Time&) const = default;
};

/// The same fields as Time.
struct Duration {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  static constexpr const char* type = "builtin_interfaces/msg/Duration";
  static constexpr auto fields = std::tuple(field("sec", &Duration::sec), field("nanosec", &Duration::nanosec));
  bool operator==(const Duration&) const = default;
};

struct Header {
  Time stamp{};
  std::string frame_id{};
  static constexpr const char* type = "std_msgs/msg/Header";
  static constexpr auto fields = std::tuple(field("stamp", &Header::stamp), field("frame_id", &Header::frame_id));
  bool operator==(const Header&) const = default;
};

struct Empty {
  static constexpr const char* type = "std_msgs/msg/Empty";
  static constexpr auto fields = std::tuple();
  bool operator==(const Empty&) const = default;
};

struct Bool {
  bool data = false;
  static constexpr const char* type = "std_msgs/msg/Bool";
  static constexpr auto fields = std::tuple(field("data", &Bool::data));
  bool operator==(const Bool&) const = default;
};

struct Int32 {
  std::int32_t data = 0;
  static constexpr const char* type = "std_msgs/msg/Int32";
  static constexpr auto fields = std::tuple(field("data", &Int32::data));
  bool operator==(const Int32&) const = default;
};

struct Float32 {
  float data = 0;
  static constexpr const char* type = "std_msgs/msg/Float32";
  static constexpr auto fields = std::tuple(field("data", &Float32::data));
  bool operator==(const Float32&) const = default;
};

struct Float64 {
  double data = 0;
  static constexpr const char* type = "std_msgs/msg/Float64";
  static constexpr auto fields = std::tuple(field("data", &Float64::data));
  bool operator==(const Float64&) const = default;
};

struct String {
  std::string data{};
  static constexpr const char* type = "std_msgs/msg/String";
  static constexpr auto fields = std::tuple(field("data", &String::data));
  bool operator==(const String&) const = default;
};

/// Red, green, blue and opacity, from 0 to 1.
struct ColorRGBA {
  float r = 0;
  float g = 0;
  float b = 0;
  float a = 0;
  static constexpr const char* type = "std_msgs/msg/ColorRGBA";
  static constexpr auto fields = std::tuple(field("r", &ColorRGBA::r), field("g", &ColorRGBA::g),
                                            field("b", &ColorRGBA::b), field("a", &ColorRGBA::a));
  bool operator==(const ColorRGBA&) const = default;
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

struct Float32MultiArray {
  MultiArrayLayout layout{};
  std::vector<float> data{};
  static constexpr const char* type = "std_msgs/msg/Float32MultiArray";
  static constexpr auto fields =
      std::tuple(field("layout", &Float32MultiArray::layout), field("data", &Float32MultiArray::data));
  bool operator==(const Float32MultiArray&) const = default;
};

struct Float64MultiArray {
  MultiArrayLayout layout{};
  std::vector<double> data{};
  static constexpr const char* type = "std_msgs/msg/Float64MultiArray";
  static constexpr auto fields =
      std::tuple(field("layout", &Float64MultiArray::layout), field("data", &Float64MultiArray::data));
  bool operator==(const Float64MultiArray&) const = default;
};

}  // namespace cohort::messages::ros
