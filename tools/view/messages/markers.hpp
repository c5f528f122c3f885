// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_messages.hpp"
#include "idl/messages/scene_messages.hpp"

/// A scene as standard ROS 2 messages, for viewers that do not know Cohort's messages. Each link has a frame
/// `NAME/LINK`, relative to the frame `world`.
namespace cohort::view {

using messages::field;

struct ColorRGBA {
  float r = 0, g = 0, b = 0, a = 1;
  static constexpr const char* type = "std_msgs/msg/ColorRGBA";
  static constexpr auto fields = std::tuple(field("r", &ColorRGBA::r), field("g", &ColorRGBA::g),
                                            field("b", &ColorRGBA::b), field("a", &ColorRGBA::a));
};

struct Duration {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  static constexpr const char* type = "builtin_interfaces/msg/Duration";
  static constexpr auto fields = std::tuple(field("sec", &Duration::sec), field("nanosec", &Duration::nanosec));
};

struct CompressedImage {
  messages::ros::Header header{};
  std::string format{};
  std::vector<std::uint8_t> data{};
  static constexpr const char* type = "sensor_msgs/msg/CompressedImage";
  static constexpr auto fields =
      std::tuple(field("header", &CompressedImage::header), field("format", &CompressedImage::format),
                 field("data", &CompressedImage::data));
};

struct UVCoordinate {
  float u = 0, v = 0;
  static constexpr const char* type = "visualization_msgs/msg/UVCoordinate";
  static constexpr auto fields = std::tuple(field("u", &UVCoordinate::u), field("v", &UVCoordinate::v));
};

struct MeshFile {
  std::string filename{};
  std::vector<std::uint8_t> data{};
  static constexpr const char* type = "visualization_msgs/msg/MeshFile";
  static constexpr auto fields = std::tuple(field("filename", &MeshFile::filename), field("data", &MeshFile::data));
};

struct Marker {
  enum Kind : std::int32_t { cube = 1, sphere = 2, cylinder = 3, triangle_list = 11 };

  messages::ros::Header header{};
  std::string ns{};
  std::int32_t id = 0;
  std::int32_t kind = cube;
  std::int32_t action = 0;  ///< 0: add; 3: delete all
  messages::ros::Pose pose{};
  messages::ros::Vector3 scale{};
  ColorRGBA color{};
  Duration lifetime{};
  bool frame_locked = true;
  std::vector<messages::ros::Point> points{};
  std::vector<ColorRGBA> colors{};
  std::string texture_resource{};
  CompressedImage texture{};
  std::vector<UVCoordinate> uv_coordinates{};
  std::string text{};
  std::string mesh_resource{};
  MeshFile mesh_file{};
  bool mesh_use_embedded_materials = false;
  static constexpr const char* type = "visualization_msgs/msg/Marker";
  static constexpr auto fields = std::tuple(
      field("header", &Marker::header), field("ns", &Marker::ns), field("id", &Marker::id),
      field("type", &Marker::kind), field("action", &Marker::action), field("pose", &Marker::pose),
      field("scale", &Marker::scale), field("color", &Marker::color), field("lifetime", &Marker::lifetime),
      field("frame_locked", &Marker::frame_locked), field("points", &Marker::points), field("colors", &Marker::colors),
      field("texture_resource", &Marker::texture_resource), field("texture", &Marker::texture),
      field("uv_coordinates", &Marker::uv_coordinates), field("text", &Marker::text),
      field("mesh_resource", &Marker::mesh_resource), field("mesh_file", &Marker::mesh_file),
      field("mesh_use_embedded_materials", &Marker::mesh_use_embedded_materials));
};

struct MarkerArray {
  std::vector<Marker> markers{};
  static constexpr const char* type = "visualization_msgs/msg/MarkerArray";
  static constexpr auto fields = std::tuple(field("markers", &MarkerArray::markers));
};

/// Returns markers for everything that is visible, with a bounded part of each plane. They replace all earlier markers.
MarkerArray markers_of(const messages::Scene& scene);
/// Returns the transforms of all links that are in the world.
messages::ros::TFMessage transforms_of(const messages::Scene& scene, const messages::SceneFrame& frame);

}  // namespace cohort::view
