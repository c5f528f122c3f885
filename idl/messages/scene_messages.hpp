// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "idl/messages/cdr.hpp"

/// Descriptions of a world for viewers, in the form of messages of a ROS 2 package `cohort_msgs`. SI units, radians;
/// frames as in description/model.hpp. A pose is x y z and a quaternion qx qy qz qw. Numbers that are only displayed
/// are float32.
namespace cohort::messages {

using Vector = std::array<float, 3>;
using PoseNumbers = std::array<float, 7>;
using Color = std::array<float, 4>;  ///< red, green, blue and opacity, from 0 to 1

inline constexpr std::uint32_t none = 0xffffffffu;

enum class ShapeKind : std::uint8_t {
  box = 0,        ///< size: edges
  sphere = 1,     ///< size: radius
  cylinder = 2,   ///< size: radius, length along z
  capsule = 3,    ///< size: radius, length along z without the hemispheres
  ellipsoid = 4,  ///< size: radii
  plane = 5,      ///< size: normal; infinite
  mesh = 6,
};

enum class ShapeRole : std::uint8_t {
  visual = 0,
  collision = 1,            ///< collision of a link that also has visuals
  collision_as_visual = 2,  ///< collision of a link without visuals
};

struct SceneShape {
  std::uint8_t kind = 0;      ///< a ShapeKind
  std::uint8_t role = 0;      ///< a ShapeRole
  std::uint32_t mesh = none;  ///< index into Scene::meshes
  Vector size{};
  PoseNumbers pose{};  ///< pose in its link
  Color color{};
  bool has_mesh_colors = false;  ///< true if the mesh has colours; only the opacity of `color` is then used
  static constexpr const char* type = "cohort_msgs/msg/SceneShape";
  static constexpr auto fields =
      std::tuple(field("kind", &SceneShape::kind), field("role", &SceneShape::role), field("mesh", &SceneShape::mesh),
                 field("size", &SceneShape::size), field("pose", &SceneShape::pose), field("color", &SceneShape::color),
                 field("has_mesh_colors", &SceneShape::has_mesh_colors));
};

struct SceneMesh {
  std::vector<float> vertices;           ///< x y z of each vertex [m]
  std::vector<std::uint32_t> triangles;  ///< three vertices each, counter-clockwise seen from outside
  std::vector<std::uint8_t> colors{};    ///< red, green, blue of each triangle; empty if there are no colours
  static constexpr const char* type = "cohort_msgs/msg/SceneMesh";
  static constexpr auto fields =
      std::tuple(field("vertices", &SceneMesh::vertices), field("triangles", &SceneMesh::triangles),
                 field("colors", &SceneMesh::colors));
};

struct SceneLink {
  std::string name;
  PoseNumbers pose{};  ///< pose in its model, with all joints at zero
  std::vector<SceneShape> shapes;
  static constexpr const char* type = "cohort_msgs/msg/SceneLink";
  static constexpr auto fields =
      std::tuple(field("name", &SceneLink::name), field("pose", &SceneLink::pose), field("shapes", &SceneLink::shapes));
};

/// The rays of a sensor: one for each vector in `directions`.
struct SceneSensor {
  std::string name;
  std::string kind;  ///< as in world files, such as `proximity_ring`
  std::uint32_t link = 0;
  std::vector<float> origins;     ///< x y z of each ray's origin in its link
  std::vector<float> directions;  ///< x y z of each ray's unit direction in its link
  float range = 0.0f;             ///< [m]
  float cone = 0.0f;              ///< full angle of the cone that a ray represents [rad]; 0: no cone
  std::string channel;            ///< channel of the first ray's reading; the others follow it in the observation
  static constexpr const char* type = "cohort_msgs/msg/SceneSensor";
  static constexpr auto fields = std::tuple(
      field("name", &SceneSensor::name), field("kind", &SceneSensor::kind), field("link", &SceneSensor::link),
      field("origins", &SceneSensor::origins), field("directions", &SceneSensor::directions),
      field("range", &SceneSensor::range), field("cone", &SceneSensor::cone), field("channel", &SceneSensor::channel));
};

struct SceneChannel {
  std::string name;  ///< `device/index/quantity`
  std::string unit;
  std::uint32_t size = 1;
  double lower = 0.0;
  double upper = 0.0;
  double neutral = 0.0;  ///< value of a command until it is set
  static constexpr const char* type = "cohort_msgs/msg/SceneChannel";
  static constexpr auto fields =
      std::tuple(field("name", &SceneChannel::name), field("unit", &SceneChannel::unit),
                 field("size", &SceneChannel::size), field("lower", &SceneChannel::lower),
                 field("upper", &SceneChannel::upper), field("neutral", &SceneChannel::neutral));
};

struct SceneModel {
  std::string name;
  bool is_static = false;
  std::vector<SceneLink> links;
  std::vector<SceneSensor> sensors;
  std::vector<SceneChannel> observation;
  std::vector<SceneChannel> command;
  static constexpr const char* type = "cohort_msgs/msg/SceneModel";
  static constexpr auto fields =
      std::tuple(field("name", &SceneModel::name), field("is_static", &SceneModel::is_static),
                 field("links", &SceneModel::links), field("sensors", &SceneModel::sensors),
                 field("observation", &SceneModel::observation), field("command", &SceneModel::command));
};

struct SceneEntity {
  std::string name;  ///< scoped name
  std::uint32_t model = 0;
  std::uint32_t robot = none;  ///< id, if it is a robot
  std::string team{};
  static constexpr const char* type = "cohort_msgs/msg/SceneEntity";
  static constexpr auto fields = std::tuple(field("name", &SceneEntity::name), field("model", &SceneEntity::model),
                                            field("robot", &SceneEntity::robot), field("team", &SceneEntity::team));
};

/// A lamp, a loudspeaker or an LED; `link` is an index into the links of a SceneFrame.
struct SceneEmitter {
  std::uint32_t entity = 0;
  std::uint32_t link = 0;
  Vector position{};   ///< position in its link
  Vector direction{};  ///< direction of a directional lamp, in its link; zero otherwise
  float range = 0.0f;  ///< [m], may be infinite
  static constexpr const char* type = "cohort_msgs/msg/SceneEmitter";
  static constexpr auto fields =
      std::tuple(field("entity", &SceneEmitter::entity), field("link", &SceneEmitter::link),
                 field("position", &SceneEmitter::position), field("direction", &SceneEmitter::direction),
                 field("range", &SceneEmitter::range));
};

/// An image that is shown on shapes.
struct SceneTexture {
  std::vector<std::uint8_t> image;  ///< content of a PNG or JPEG file
  static constexpr const char* type = "cohort_msgs/msg/SceneTexture";
  static constexpr auto fields = std::tuple(field("image", &SceneTexture::image));
};

/// The texture coordinates and textures of a mesh.
struct SceneMeshTexture {
  std::uint32_t mesh = 0;          ///< index into Scene::meshes
  std::vector<float> coordinates;  ///< u and v of each corner of each triangle; v is 0 at the lower edge of an image
  /// Index into Scene::textures for each triangle, or `none`; empty if there are none. It applies to shapes that have
  /// the colours of the mesh.
  std::vector<std::uint32_t> textures;
  static constexpr const char* type = "cohort_msgs/msg/SceneMeshTexture";
  static constexpr auto fields =
      std::tuple(field("mesh", &SceneMeshTexture::mesh), field("coordinates", &SceneMeshTexture::coordinates),
                 field("textures", &SceneMeshTexture::textures));
};

/// The texture of a whole shape, which is shown instead of its colour.
struct SceneShapeTexture {
  std::uint32_t model = 0;
  std::uint32_t link = 0;     ///< index into the links of the model
  std::uint32_t shape = 0;    ///< index into the shapes of the link
  std::uint32_t texture = 0;  ///< index into Scene::textures
  static constexpr const char* type = "cohort_msgs/msg/SceneShapeTexture";
  static constexpr auto fields =
      std::tuple(field("model", &SceneShapeTexture::model), field("link", &SceneShapeTexture::link),
                 field("shape", &SceneShapeTexture::shape), field("texture", &SceneShapeTexture::texture));
};

/// A value of a command that drives a robot over the ground.
struct SceneDrive {
  std::uint32_t model = 0;
  std::uint32_t value = 0;  ///< index into the values of the model's command
  double ahead = 0.0;       ///< value that drives forward at full speed, in the unit of its channel
  double turn = 0.0;        ///< value that turns counter-clockwise at full speed
  static constexpr const char* type = "cohort_msgs/msg/SceneDrive";
  static constexpr auto fields = std::tuple(field("model", &SceneDrive::model), field("value", &SceneDrive::value),
                                            field("ahead", &SceneDrive::ahead), field("turn", &SceneDrive::turn));
};

/// The contents of a world. A new scene is sent for each world, when objects are added, and at the end of the last run;
/// this last scene is empty.
struct Scene {
  std::uint32_t revision = 0;  ///< identifies the scene in frames; a source never repeats it
  std::string world;
  std::int64_t step_ns = 0;
  std::vector<SceneMesh> meshes;
  std::vector<SceneModel> models;
  std::vector<SceneEntity> entities;
  std::vector<SceneEmitter> lamps;
  std::vector<SceneEmitter> tones;
  std::vector<SceneEmitter> leds;
  std::string end{};       ///< end of the run as in recordings, such as `finished`; empty while it runs
  std::string end_text{};  ///< human-readable reason; may be empty
  std::vector<SceneTexture> textures{};
  std::vector<SceneMeshTexture> mesh_textures{};
  std::vector<SceneShapeTexture> shape_textures{};
  std::vector<SceneDrive> drives{};  ///< sorted by model
  static constexpr const char* type = "cohort_msgs/msg/Scene";
  static constexpr std::size_t least_fields = 11;  ///< fields of version 0.1, up to `end_text`
  static constexpr auto fields =
      std::tuple(field("revision", &Scene::revision), field("world", &Scene::world), field("step_ns", &Scene::step_ns),
                 field("meshes", &Scene::meshes), field("models", &Scene::models), field("entities", &Scene::entities),
                 field("lamps", &Scene::lamps), field("tones", &Scene::tones), field("leds", &Scene::leds),
                 field("end", &Scene::end), field("end_text", &Scene::end_text), field("textures", &Scene::textures),
                 field("mesh_textures", &Scene::mesh_textures), field("shape_textures", &Scene::shape_textures),
                 field("drives", &Scene::drives));
};

/// The poses at a boundary. Links are sorted by model, then by link of the model, then by entity of that model, so that
/// all instances of one link are contiguous.
struct SceneFrame {
  std::uint32_t revision = 0;
  std::uint32_t run = 0;
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::uint64_t state_hash = 0;
  std::vector<std::uint32_t> absent;       ///< entities that are not in the world, in ascending order
  std::vector<std::uint32_t> quarantined;  ///< entities that are no longer simulated, in ascending order
  std::vector<float> positions;            ///< x y z of each link in the world frame
  std::vector<std::int16_t> orientations;  ///< qx qy qz qw of each link, times 32767
  static constexpr const char* type = "cohort_msgs/msg/SceneFrame";
  static constexpr auto fields = std::tuple(
      field("revision", &SceneFrame::revision), field("run", &SceneFrame::run), field("tick", &SceneFrame::tick),
      field("time_ns", &SceneFrame::time_ns), field("state_hash", &SceneFrame::state_hash),
      field("absent", &SceneFrame::absent), field("quarantined", &SceneFrame::quarantined),
      field("positions", &SceneFrame::positions), field("orientations", &SceneFrame::orientations));
};

/// The output of lamps, loudspeakers and LEDs, in the order of the scene.
struct SceneSignals {
  std::uint32_t revision = 0;
  std::vector<float> lamps;        ///< red, green, blue and intensity of each; 0 if it is off
  std::vector<float> tones;        ///< frequency [Hz] and intensity of each; 0 if it is silent
  std::vector<std::uint8_t> leds;  ///< red, green, blue of each, from 0 to 255
  static constexpr const char* type = "cohort_msgs/msg/SceneSignals";
  static constexpr auto fields =
      std::tuple(field("revision", &SceneSignals::revision), field("lamps", &SceneSignals::lamps),
                 field("tones", &SceneSignals::tones), field("leds", &SceneSignals::leds));
  bool operator==(const SceneSignals&) const = default;
};

/// Contacts and grips at a boundary.
struct SceneContacts {
  std::uint32_t revision = 0;
  std::vector<float> positions;  ///< x y z of each contact point in the world frame
  std::vector<float> forces;  ///< x y z of each contact's normal force, of entity b on entity a, over the last step [N]
  std::vector<std::uint32_t> entities;  ///< a and b of each contact
  std::vector<float> grips;             ///< x y z of the jaw of each gripper that holds something, and the force [N]
  static constexpr const char* type = "cohort_msgs/msg/SceneContacts";
  static constexpr auto fields =
      std::tuple(field("revision", &SceneContacts::revision), field("positions", &SceneContacts::positions),
                 field("forces", &SceneContacts::forces), field("entities", &SceneContacts::entities),
                 field("grips", &SceneContacts::grips));
};

/// The observation and command of one robot, as float64 in the order of its model's channels.
struct SceneRobot {
  std::uint32_t revision = 0;
  std::uint32_t robot = 0;
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::vector<double> observation;
  std::vector<double> command;
  static constexpr const char* type = "cohort_msgs/msg/SceneRobot";
  static constexpr auto fields =
      std::tuple(field("revision", &SceneRobot::revision), field("robot", &SceneRobot::robot),
                 field("tick", &SceneRobot::tick), field("time_ns", &SceneRobot::time_ns),
                 field("observation", &SceneRobot::observation), field("command", &SceneRobot::command));
};

/// A selection of robots.
struct SceneRobots {
  std::vector<SceneRobot> robots;
  static constexpr const char* type = "cohort_msgs/msg/SceneRobots";
  static constexpr auto fields = std::tuple(field("robots", &SceneRobots::robots));
};

}  // namespace cohort::messages
