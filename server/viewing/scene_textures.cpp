// SPDX-License-Identifier: Apache-2.0
#include "server/viewing/scene_textures.hpp"

#include <algorithm>

namespace cohort::viewing {

void TextureWriter::add(const description::Visual& visual, std::uint32_t model, std::uint32_t link,
                        std::uint32_t shape) {
  const messages::SceneShape& written = scene_.models[model].links[link].shapes[shape];
  const std::uint32_t texture = index_of(visual.texture.get());
  if (texture != messages::none) scene_.shape_textures.push_back({model, link, shape, texture});
  const auto* const mesh = std::get_if<description::Mesh>(&visual.shape);
  if (mesh == nullptr || mesh->triangles->textures.coordinates.empty()) return;
  const description::MeshTextures& textures = mesh->triangles->textures;
  if (texture != messages::none || (written.has_mesh_colors && !textures.of_triangles.empty()))
    add_mesh(written.mesh, textures);
}

std::uint32_t TextureWriter::index_of(const description::Image* image) {
  if (image == nullptr) return messages::none;
  if (const auto known = indices_.find(image->bytes); known != indices_.end()) return known->second;
  const auto index = static_cast<std::uint32_t>(scene_.textures.size());
  const bool fits = !budget_.add(image->bytes.size(), image->size);
  if (fits) scene_.textures.push_back({{image->bytes.begin(), image->bytes.end()}});
  return indices_.emplace(image->bytes, fits ? index : messages::none).first->second;
}

void TextureWriter::add_mesh(std::uint32_t mesh, const description::MeshTextures& textures) {
  if (!meshes_.insert(mesh).second) return;
  messages::SceneMeshTexture& written = scene_.mesh_textures.emplace_back();
  written.mesh = mesh;
  written.coordinates.reserve(6 * textures.coordinates.size());
  for (const auto& corners : textures.coordinates)
    for (const auto& corner : corners)
      written.coordinates.insert(written.coordinates.end(), corner.begin(), corner.end());
  std::vector<std::uint32_t> indices;
  indices.reserve(textures.images.size());
  for (const auto& image : textures.images) indices.push_back(index_of(image.get()));
  written.textures.reserve(textures.of_triangles.size());
  for (const std::uint32_t image : textures.of_triangles)
    written.textures.push_back(image < indices.size() ? indices[image] : messages::none);
}

}  // namespace cohort::viewing
