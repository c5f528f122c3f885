// SPDX-License-Identifier: Apache-2.0
#include "server/viewing/check_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "server/description/texture_image.hpp"

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

void check_textures(const messages::Scene& scene) {
  description::ImageBudget budget;
  for (const messages::SceneTexture& texture : scene.textures) {
    const std::string_view bytes(reinterpret_cast<const char*>(texture.image.data()), texture.image.size());
    try {
      expect(!budget.add(bytes.size(), description::checked_image_size(bytes)), "the textures are too large");
    } catch (const std::runtime_error& error) {
      throw messages::CdrError(std::string("a texture is invalid: ") + error.what());
    }
  }
}

void check_mesh_texture(const messages::Scene& scene, const messages::SceneMeshTexture& texture) {
  expect(texture.mesh < scene.meshes.size(), "a texture has an unknown mesh");
  const std::size_t corners = scene.meshes[texture.mesh].triangles.size();
  expect(texture.coordinates.size() == 2 * corners, "a mesh has different numbers of texture coordinates and corners");
  expect(texture.textures.empty() || 3 * texture.textures.size() == corners,
         "a mesh has different numbers of textures and triangles");
  expect(std::ranges::all_of(
             texture.textures,
             [&](std::uint32_t index) { return index == messages::none || index < scene.textures.size(); }),
         "a mesh has an unknown texture");
}

void check_shape_texture(const messages::Scene& scene, const messages::SceneShapeTexture& texture) {
  expect(texture.model < scene.models.size() && texture.link < scene.models[texture.model].links.size() &&
             texture.shape < scene.models[texture.model].links[texture.link].shapes.size(),
         "a texture has an unknown shape");
  expect(texture.texture < scene.textures.size(), "a shape has an unknown texture");
}

void check_drive(const messages::Scene& scene, const messages::SceneDrive& drive) {
  expect(drive.model < scene.models.size(), "a drive has an unknown model");
  std::uint64_t values = 0;
  for (const messages::SceneChannel& channel : scene.models[drive.model].command) values += channel.size;
  expect(drive.value < values, "a drive has an unknown value");
  expect(std::isfinite(drive.ahead) && std::isfinite(drive.turn), "a drive is not finite");
}

}  // namespace

std::size_t check_scene(const messages::Scene& scene) {
  std::ranges::for_each(scene.meshes, check_mesh);
  for (const messages::SceneModel& model : scene.models)
    for (const messages::SceneLink& link : model.links)
      for (const messages::SceneShape& shape : link.shapes) check_shape(scene, shape);
  check_textures(scene);
  for (const messages::SceneMeshTexture& texture : scene.mesh_textures) check_mesh_texture(scene, texture);
  for (const messages::SceneShapeTexture& texture : scene.shape_textures) check_shape_texture(scene, texture);
  for (const messages::SceneDrive& drive : scene.drives) check_drive(scene, drive);
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
