// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "server/core/ids.hpp"
#include "server/description/model.hpp"
#include "server/geometry/shapes/mesh_surface.hpp"
#include "server/geometry/shapes/shapes.hpp"

namespace cohort::geometry {

/// The common data of all solids of one collision of a model, in all its bodies and worlds. Immutable.
struct SolidKind {
  Shape shape;
  description::Surface surface;
  std::uint32_t link = 0;       ///< index in the model
  std::uint32_t collision = 0;  ///< index in the link
  Eigen::Vector3d color = description::default_color();
  double radius = 0.0;  ///< bounding ball around the origin of C [m], infinite for planes and height maps
  std::shared_ptr<const MeshSurface> mesh{};  ///< for a mesh
};
using SolidKindPtr = std::shared_ptr<const SolidKind>;

/// Computes the radius and, unless it exists already, the surface of a mesh.
SolidKindPtr make_solid_kind(SolidKind kind);

/// One collision shape, placed in the world.
struct Solid {
  SolidKindPtr kind;
  BodyId body;  ///< its body; ray queries can ignore all solids of a body
  bool moves = false;
  double radius = 0.0;  ///< copy of that of the kind, for locality
  Pose X_WC;

  const Shape& shape() const { return kind->shape; }
  const description::Surface& surface() const { return kind->surface; }
  std::uint32_t link() const { return kind->link; }
  std::uint32_t collision() const { return kind->collision; }
  const Eigen::Vector3d& color() const { return kind->color; }
};

/// The kinds of solids of a world's models. Copies share them.
class SolidKinds {
 public:
  /// Returns the kinds of the model's collisions, in the order of the links. `index`: index of the model in its world.
  const std::vector<SolidKindPtr>& of_model(std::size_t index, const description::Model& model);

 private:
  using MeshKey = std::pair<const description::TriangleMesh*, bool>;  // the bool: convex

  std::vector<std::shared_ptr<const std::vector<SolidKindPtr>>> by_model_;  // null: not requested yet
  std::map<MeshKey, std::shared_ptr<const MeshSurface>> meshes_;
};

}  // namespace cohort::geometry
