// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/scene/solid.hpp"

namespace cohort::geometry {

SolidKindPtr make_solid_kind(SolidKind kind) {
  constexpr double rounding = 1e-9;
  kind.radius = radius_of(kind.shape) * (1.0 + rounding) + rounding;
  if (const auto* const mesh = std::get_if<description::Mesh>(&kind.shape); mesh != nullptr && !kind.mesh)
    kind.mesh = std::make_shared<const MeshSurface>(*mesh);
  return std::make_shared<const SolidKind>(std::move(kind));
}

const std::vector<SolidKindPtr>& SolidKinds::of_model(std::size_t index, const description::Model& model) {
  if (index >= by_model_.size()) by_model_.resize(index + 1);
  if (by_model_[index]) return *by_model_[index];
  std::vector<SolidKindPtr> kinds;
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    const std::vector<description::Collision>& collisions = model.links[link].collisions;
    for (std::size_t i = 0; i < collisions.size(); ++i) {
      SolidKind kind{collisions[i].shape, collisions[i].surface, static_cast<std::uint32_t>(link),
                     static_cast<std::uint32_t>(i), model.links[link].color};
      std::shared_ptr<const MeshSurface>* known = nullptr;
      if (const auto* const mesh = std::get_if<description::Mesh>(&kind.shape))
        known = &meshes_[{mesh->triangles.get(), mesh->convex}];
      if (known != nullptr) kind.mesh = *known;
      kinds.push_back(make_solid_kind(std::move(kind)));
      if (known != nullptr) *known = kinds.back()->mesh;
    }
  }
  by_model_[index] = std::make_shared<const std::vector<SolidKindPtr>>(std::move(kinds));
  return *by_model_[index];
}

}  // namespace cohort::geometry
