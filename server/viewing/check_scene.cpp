#include "server/viewing/check_scene.hpp"

#include <algorithm>

namespace cohort::viewing {
namespace {

void expect(bool holds, const char* otherwise) {
  if (!holds) throw messages::CdrError(otherwise);
}

void check_mesh(const messages::SceneMesh& mesh) {
  const std::size_t vertices = mesh.vertices.size() / 3;
  expect(std::ranges::all_of(mesh.triangles, [&](std::uint32_t vertex) { return vertex < vertices; }),
         "a triangle refers to an unknown vertex");
  expect(mesh.colors.empty() || mesh.colors.size() == mesh.triangles.size(),
         "a mesh has different numbers of colours and triangles");
}

void check_shape(const messages::Scene& scene, const messages::SceneShape& shape) {
  const bool is_mesh = shape.kind == static_cast<std::uint8_t>(messages::ShapeKind::mesh);
  expect(!is_mesh || shape.mesh < scene.meshes.size(), "a shape has an unknown mesh");
  expect(!shape.has_mesh_colors || (is_mesh && !scene.meshes[shape.mesh].colors.empty()),
         "a shape uses the colours of a mesh without colours");
}

}  // namespace

std::size_t check_scene(const messages::Scene& scene) {
  std::ranges::for_each(scene.meshes, check_mesh);
  for (const messages::SceneModel& model : scene.models)
    for (const messages::SceneLink& link : model.links)
      for (const messages::SceneShape& shape : link.shapes) check_shape(scene, shape);
  std::size_t links = 0;
  for (const messages::SceneEntity& entity : scene.entities) {
    expect(entity.model < scene.models.size(), "an object has an unknown model");
    links += scene.models[entity.model].links.size();
  }
  return links;
}

void check_frame(const messages::SceneFrame& frame, std::size_t links) {
  expect(frame.positions.size() == 3 * links && frame.orientations.size() == 4 * links,
         "a frame and its scene have different numbers of links");
}

}  // namespace cohort::viewing
