// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string_view>

#include "idl/messages/scene_messages.hpp"
#include "server/description/model.hpp"

namespace cohort::viewing {

/// Writes the textures of a scene. Equal images are written once. Images beyond the limits of a world are omitted.
class TextureWriter {
 public:
  explicit TextureWriter(messages::Scene& scene) : scene_(scene) {}

  /// Adds the textures of a visual, which is the shape with these indices: its own, or those of its mesh.
  void add(const description::Visual& visual, std::uint32_t model, std::uint32_t link, std::uint32_t shape);

 private:
  std::uint32_t index_of(const description::Image* image);
  void add_mesh(std::uint32_t mesh, const description::MeshTextures& textures);

  messages::Scene& scene_;
  description::ImageBudget budget_;
  std::map<std::string_view, std::uint32_t> indices_;  // by content
  std::set<std::uint32_t> meshes_;                     // those that are written
};

}  // namespace cohort::viewing
