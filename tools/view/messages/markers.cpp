// SPDX-License-Identifier: Apache-2.0
#include "tools/view/messages/markers.hpp"

#include <algorithm>

namespace cohort::view {
namespace {

using messages::ShapeKind;

constexpr double plane_size = 20.0;       // [m]
constexpr double plane_thickness = 1e-3;  // [m]

std::string frame_name(const messages::Scene& scene, std::uint32_t entity, std::size_t link) {
  const messages::SceneEntity& named = scene.entities[entity];
  return named.name + "/" + scene.models[named.model].links[link].name;
}

void fill_colors(const messages::SceneMesh& mesh, float opacity, Marker& marker) {
  constexpr float full = 255.0f;
  marker.colors.reserve(mesh.colors.size());
  for (std::size_t i = 0; i + 2 < mesh.colors.size(); i += 3) {
    const auto part = [&](std::size_t which) { return static_cast<float>(mesh.colors[i + which]) / full; };
    marker.colors.insert(marker.colors.end(), 3, {part(0), part(1), part(2), opacity});  // colours of its corners
  }
}

void fill_mesh(const messages::SceneMesh& mesh, Marker& marker) {
  marker.kind = Marker::triangle_list;
  marker.scale = {1.0, 1.0, 1.0};
  marker.points.reserve(mesh.triangles.size());
  for (const std::uint32_t vertex : mesh.triangles) {
    const float* const p = mesh.vertices.data() + std::size_t{3} * vertex;
    marker.points.push_back({p[0], p[1], p[2]});
  }
}

void fill_shape(const messages::Scene& scene, const messages::SceneShape& shape, Marker& marker) {
  const auto& [a, b, c] = shape.size;
  switch (static_cast<ShapeKind>(shape.kind)) {
    case ShapeKind::box: marker.scale = {a, b, c}; break;
    case ShapeKind::sphere:
      marker.kind = Marker::sphere;
      marker.scale = {2.0 * a, 2.0 * a, 2.0 * a};
      break;
    case ShapeKind::cylinder:
    case ShapeKind::capsule:
      marker.kind = Marker::cylinder;
      marker.scale = {2.0 * a, 2.0 * a, b};
      break;
    case ShapeKind::ellipsoid:
      marker.kind = Marker::sphere;
      marker.scale = {2.0 * a, 2.0 * b, 2.0 * c};
      break;
    case ShapeKind::plane: marker.scale = {plane_size, plane_size, plane_thickness}; break;
    case ShapeKind::mesh:
      fill_mesh(scene.meshes[shape.mesh], marker);
      if (shape.has_mesh_colors) fill_colors(scene.meshes[shape.mesh], shape.color[3], marker);
      break;
  }
}

Marker marker_of(const messages::Scene& scene, const messages::SceneShape& shape) {
  Marker marker;
  const auto& pose = shape.pose;
  marker.pose = {{pose[0], pose[1], pose[2]}, {pose[3], pose[4], pose[5], pose[6]}};
  marker.color = {shape.color[0], shape.color[1], shape.color[2], shape.color[3]};
  fill_shape(scene, shape, marker);
  return marker;
}

void add_link(const messages::Scene& scene, const messages::SceneLink& link, const std::string& frame,
              MarkerArray& to) {
  for (const messages::SceneShape& shape : link.shapes) {
    if (shape.role == static_cast<std::uint8_t>(messages::ShapeRole::collision)) continue;
    Marker marker = marker_of(scene, shape);
    marker.header.frame_id = frame;
    marker.ns = frame;
    marker.id = static_cast<std::int32_t>(to.markers.size());
    to.markers.push_back(std::move(marker));
  }
}

}  // namespace

MarkerArray markers_of(const messages::Scene& scene) {
  MarkerArray all;
  all.markers.reserve(1 + scene.entities.size());
  Marker& clear = all.markers.emplace_back();
  clear.header.frame_id = "world";
  clear.action = 3;
  for (std::uint32_t entity = 0; entity < scene.entities.size(); ++entity) {
    const messages::SceneModel& model = scene.models[scene.entities[entity].model];
    for (std::size_t link = 0; link < model.links.size(); ++link)
      add_link(scene, model.links[link], frame_name(scene, entity, link), all);
  }
  return all;
}

messages::ros::TFMessage transforms_of(const messages::Scene& scene, const messages::SceneFrame& frame) {
  constexpr std::int64_t second = 1'000'000'000;
  constexpr double full = 32767.0;
  const messages::ros::Time stamp{static_cast<std::int32_t>(frame.time_ns / second),
                                  static_cast<std::uint32_t>(frame.time_ns % second)};
  std::vector<std::vector<std::uint32_t>> entities_of_model(scene.models.size());
  for (std::uint32_t entity = 0; entity < scene.entities.size(); ++entity)
    entities_of_model[scene.entities[entity].model].push_back(entity);

  messages::ros::TFMessage message;
  message.transforms.reserve(frame.positions.size() / 3);
  std::size_t place = 0;
  const auto add = [&](std::uint32_t entity, std::size_t link) {
    const float* const p = frame.positions.data() + 3 * place;
    const std::int16_t* const q = frame.orientations.data() + 4 * place;
    ++place;
    if (std::ranges::binary_search(frame.absent, entity)) return;
    message.transforms.push_back({{stamp, "world"},
                                  frame_name(scene, entity, link),
                                  {{p[0], p[1], p[2]}, {q[0] / full, q[1] / full, q[2] / full, q[3] / full}}});
  };
  for (std::size_t model = 0; model < scene.models.size(); ++model)
    for (std::size_t link = 0; link < scene.models[model].links.size(); ++link)
      for (const std::uint32_t entity : entities_of_model[model]) add(entity, link);
  return message;
}

}  // namespace cohort::view
