// SPDX-License-Identifier: Apache-2.0
#include "server/viewing/scene_models.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "server/description/ground_drive.hpp"
#include "server/viewing/scene_textures.hpp"

namespace cohort::viewing {
namespace {

float number(double value) { return static_cast<float>(value); }

messages::PoseNumbers numbers_of(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  return {number(pose.position.x()),
          number(pose.position.y()),
          number(pose.position.z()),
          number(q.x()),
          number(q.y()),
          number(q.z()),
          number(q.w())};
}

messages::SceneMesh mesh_of(const description::TriangleMesh& triangles) {
  messages::SceneMesh mesh;
  mesh.vertices.reserve(3 * triangles.vertices.size());
  for (const Eigen::Vector3d& vertex : triangles.vertices)
    for (const double part : vertex) mesh.vertices.push_back(number(part));
  mesh.triangles.reserve(3 * triangles.triangles.size());
  for (const auto& triangle : triangles.triangles)
    mesh.triangles.insert(mesh.triangles.end(), triangle.begin(), triangle.end());
  mesh.colors.reserve(3 * triangles.colors.size());
  for (const auto& color : triangles.colors) mesh.colors.insert(mesh.colors.end(), color.begin(), color.end());
  return mesh;
}

// Returns the triangles as specified by description::Heightmap.
messages::SceneMesh mesh_of(const description::HeightGrid& grid) {
  const Eigen::Vector2d half = grid.half_size();
  messages::SceneMesh mesh;
  mesh.vertices.reserve(3 * grid.columns * grid.rows);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      mesh.vertices.push_back(number(static_cast<double>(column) * grid.spacing.x() - half.x()));
      mesh.vertices.push_back(number(static_cast<double>(row) * grid.spacing.y() - half.y()));
      mesh.vertices.push_back(number(grid.height(column, row)));
    }
  }
  mesh.triangles.reserve(6 * (grid.columns - 1) * (grid.rows - 1));
  const auto vertex = [&](std::size_t column, std::size_t row) {
    return static_cast<std::uint32_t>(row * grid.columns + column);
  };
  for (std::size_t row = 0; row + 1 < grid.rows; ++row) {
    for (std::size_t column = 0; column + 1 < grid.columns; ++column) {
      const std::uint32_t right = vertex(column + 1, row), above = vertex(column, row + 1);
      mesh.triangles.insert(mesh.triangles.end(), {vertex(column, row), right, above});
      mesh.triangles.insert(mesh.triangles.end(), {right, vertex(column + 1, row + 1), above});
    }
  }
  return mesh;
}

// A writer of shapes, and of the meshes that they share.
class ShapeWriter {
 public:
  explicit ShapeWriter(std::vector<messages::SceneMesh>& meshes) : meshes_(meshes) {}

  messages::SceneShape shape(const description::Shape& from) {
    messages::SceneShape shape;
    std::visit([&](const auto& each) { fill(shape, each); }, from);
    return shape;
  }

 private:
  static void fill(messages::SceneShape& shape, messages::ShapeKind kind, const messages::Vector& size) {
    shape.kind = static_cast<std::uint8_t>(kind);
    shape.size = size;
  }
  static void fill(messages::SceneShape& shape, const description::Box& box) {
    fill(shape, messages::ShapeKind::box, vector_of(box.size));
  }
  static void fill(messages::SceneShape& shape, const description::Sphere& sphere) {
    fill(shape, messages::ShapeKind::sphere, {number(sphere.radius)});
  }
  static void fill(messages::SceneShape& shape, const description::Cylinder& cylinder) {
    fill(shape, messages::ShapeKind::cylinder, {number(cylinder.radius), number(cylinder.length)});
  }
  static void fill(messages::SceneShape& shape, const description::Capsule& capsule) {
    fill(shape, messages::ShapeKind::capsule, {number(capsule.radius), number(capsule.length)});
  }
  static void fill(messages::SceneShape& shape, const description::Ellipsoid& ellipsoid) {
    fill(shape, messages::ShapeKind::ellipsoid, vector_of(ellipsoid.radii));
  }
  static void fill(messages::SceneShape& shape, const description::Plane& plane) {
    fill(shape, messages::ShapeKind::plane, vector_of(plane.normal));
  }
  void fill(messages::SceneShape& shape, const description::Mesh& mesh) { fill_mesh(shape, *mesh.triangles); }
  void fill(messages::SceneShape& shape, const description::Heightmap& map) { fill_mesh(shape, *map.grid); }

  template <class Source>
  void fill_mesh(messages::SceneShape& shape, const Source& source) {
    fill(shape, messages::ShapeKind::mesh, {});
    const auto [found, is_new] = indices_.try_emplace(&source, static_cast<std::uint32_t>(meshes_.size()));
    if (is_new) meshes_.push_back(mesh_of(source));
    shape.mesh = found->second;
  }

  std::vector<messages::SceneMesh>& meshes_;
  std::map<const void*, std::uint32_t> indices_;
};

messages::SceneLink link_of(const description::Link& from, ShapeWriter& writer) {
  messages::SceneLink link;
  link.name = from.name;
  link.pose = numbers_of(from.X_ML);
  link.shapes.reserve(from.visuals.size() + from.collisions.size());
  const auto add = [&](const description::Shape& shape, const Pose& pose, messages::ShapeRole role,
                       const Eigen::Vector4d& color) {
    messages::SceneShape& added = link.shapes.emplace_back(writer.shape(shape));
    added.role = static_cast<std::uint8_t>(role);
    added.pose = numbers_of(pose);
    for (int part = 0; part < 4; ++part) added.color.at(static_cast<std::size_t>(part)) = number(color[part]);
  };
  for (const description::Visual& visual : from.visuals) {
    add(visual.shape, visual.X_LV, messages::ShapeRole::visual, visual.color);
    const auto* const mesh = std::get_if<description::Mesh>(&visual.shape);
    link.shapes.back().has_mesh_colors = mesh != nullptr && !visual.has_color && !mesh->triangles->colors.empty();
  }
  const messages::ShapeRole role =
      from.visuals.empty() ? messages::ShapeRole::collision_as_visual : messages::ShapeRole::collision;
  for (const description::Collision& collision : from.collisions)
    add(collision.shape, collision.X_LC, role, {from.color.x(), from.color.y(), from.color.z(), 1.0});
  return link;
}

// The visuals are the first shapes of each link.
void add_textures(const description::Model& from, std::uint32_t model, TextureWriter& writer) {
  for (std::uint32_t link = 0; link < from.links.size(); ++link)
    for (std::uint32_t shape = 0; shape < from.links[link].visuals.size(); ++shape)
      writer.add(from.links[link].visuals[shape], model, link, shape);
}

// Adds a ray from a point in S along a direction in S.
void add_ray(messages::SceneSensor& sensor, const Pose& X_LS, const Eigen::Vector3d& p_S,
             const Eigen::Vector3d& direction_S) {
  for (const double part : X_LS* p_S) sensor.origins.push_back(number(part));
  for (const double part : X_LS.orientation* direction_S) sensor.directions.push_back(number(part));
}

messages::SceneSensor sensor_on(const std::string& name, const char* kind, std::size_t link, std::size_t rays) {
  messages::SceneSensor sensor;
  sensor.name = name;
  sensor.kind = kind;
  sensor.link = static_cast<std::uint32_t>(link);
  sensor.origins.reserve(3 * rays);
  sensor.directions.reserve(3 * rays);
  return sensor;
}

Eigen::Vector3d outwards(double bearing, double elevation = 0.0) {
  return {std::cos(elevation) * std::cos(bearing), std::cos(elevation) * std::sin(bearing), std::sin(elevation)};
}

messages::SceneSensor shown(const description::ProximityRing& ring) {
  messages::SceneSensor sensor = sensor_on(ring.name, "proximity_ring", ring.link, ring.count);
  for (std::size_t i = 0; i < ring.count; ++i) {
    const Eigen::Vector3d direction = outwards(ring.first_bearing + static_cast<double>(i) * ring.spacing);
    add_ray(sensor, ring.X_LS, ring.ring_radius * direction, direction);
  }
  sensor.range = number(ring.range);
  sensor.cone = number(ring.cone);
  sensor.channel = ring.name + "/0/reading";
  return sensor;
}

messages::SceneSensor shown(const description::GroundSensors& ground) {
  messages::SceneSensor sensor = sensor_on(ground.name, "ground_sensors", ground.link, ground.places_L.size());
  for (const Eigen::Vector3d& place : ground.places_L) add_ray(sensor, {}, place, -Eigen::Vector3d::UnitZ());
  sensor.range = number(ground.range);
  sensor.channel = ground.name + "/0/reading";
  return sensor;
}

messages::SceneSensor shown(const description::LightSensors& light) {
  messages::SceneSensor sensor = sensor_on(light.name, "light_sensors", light.link, light.count);
  for (std::size_t i = 0; i < light.count; ++i)
    add_ray(sensor, light.X_LS, Eigen::Vector3d::Zero(),
            outwards(light.first_bearing + static_cast<double>(i) * light.spacing));
  sensor.channel = light.name + "/0/reading";
  return sensor;
}

double between(double lower, double upper, std::size_t index, std::size_t count) {
  if (count < 2) return 0.5 * (lower + upper);
  return lower + (upper - lower) * static_cast<double>(index) / static_cast<double>(count - 1);
}

messages::SceneSensor shown(const description::Lidar& lidar) {
  messages::SceneSensor sensor = sensor_on(lidar.name, "lidar", lidar.link, lidar.rows * lidar.columns);
  for (std::size_t row = 0; row < lidar.rows; ++row)
    for (std::size_t column = 0; column < lidar.columns; ++column)
      add_ray(sensor, lidar.X_LS, Eigen::Vector3d::Zero(),
              outwards(between(lidar.min_bearing, lidar.max_bearing, column, lidar.columns),
                       between(lidar.min_elevation, lidar.max_elevation, row, lidar.rows)));
  sensor.range = number(lidar.max_range);
  sensor.channel = lidar.name + "/0/ranges";
  return sensor;
}

template <class Device>
std::optional<messages::SceneSensor> shown(const Device&) {
  return std::nullopt;
}

std::vector<messages::SceneSensor> sensors_of(const description::Model& model) {
  std::vector<messages::SceneSensor> sensors;
  sensors.reserve(model.devices.size());
  for (const description::Device& device : model.devices)
    std::visit(
        [&](const auto& each) {
          if (std::optional<messages::SceneSensor> sensor = shown(each)) sensors.push_back(*std::move(sensor));
        },
        device);
  return sensors;
}

std::vector<messages::SceneChannel> channels_of(const std::vector<Channel>& from) {
  std::vector<messages::SceneChannel> channels;
  channels.reserve(from.size());
  for (const Channel& channel : from)
    channels.push_back({channel.name, channel.unit, channel.size, channel.lower, channel.upper, channel.neutral});
  return channels;
}

// Adds the values by which people drive robots of a model.
void add_drives(const description::Model& from, std::uint32_t model, const std::vector<Channel>& command,
                std::vector<messages::SceneDrive>& drives) {
  for (const description::DriveChannel& each : description::ground_drive(from)) {
    std::uint32_t value = 0;
    for (const Channel& channel : command) {
      if (channel.name == each.channel) drives.push_back({model, value, each.ahead, each.turn});
      value += channel.size;
    }
  }
}

}  // namespace

void add_models(const Simulation& simulation, messages::Scene& scene) {
  const description::World& world = simulation.description();
  ShapeWriter writer(scene.meshes);
  TextureWriter textures(scene);
  scene.models.reserve(world.models.size());
  for (const description::Model& from : world.models) {
    messages::SceneModel& model = scene.models.emplace_back();
    model.name = from.name;
    model.is_static = from.is_static;
    model.links.reserve(from.links.size());
    for (const description::Link& link : from.links) model.links.push_back(link_of(link, writer));
    add_textures(from, static_cast<std::uint32_t>(scene.models.size() - 1), textures);
    model.sensors = sensors_of(from);
  }
  for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
    messages::SceneModel& model = scene.models[world.robot(robot).model];
    if (!model.observation.empty() || !model.command.empty()) continue;
    const RobotKind& kind = simulation.kinds()[simulation.kind_of(robot)];
    model.observation = channels_of(kind.observation);
    model.command = channels_of(kind.command);
    const auto number = static_cast<std::uint32_t>(world.robot(robot).model);
    add_drives(world.models[number], number, kind.command, scene.drives);
  }
  std::ranges::stable_sort(scene.drives, {}, &messages::SceneDrive::model);
}

}  // namespace cohort::viewing
