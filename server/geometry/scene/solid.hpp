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

/// What the solids of one collision of a model have in common, however many bodies and worlds have one. Constant.
struct SolidKind {
  Shape shape;
  description::Surface surface;
  std::uint32_t link = 0;       ///< of the model
  std::uint32_t collision = 0;  ///< of the link
  Eigen::Vector3d color = description::default_color();
  double radius = 0.0;  ///< of a ball around the origin of C that holds it [m], infinite for planes and height maps
  std::shared_ptr<const MeshSurface> mesh{};  ///< of a mesh
};
using SolidKindPtr = std::shared_ptr<const SolidKind>;

/// Fills in the radius and, unless there is one already, the surface of a mesh.
SolidKindPtr make_solid_kind(SolidKind kind);

/// One collision shape, placed in the world.
struct Solid {
  SolidKindPtr kind;
  BodyId body;  ///< whose it is; solids of one body do not see each other
  bool moves = false;
  double radius = 0.0;  ///< of its kind; where it is read, so is the rest
  Pose X_WC;

  const Shape& shape() const { return kind->shape; }
  const description::Surface& surface() const { return kind->surface; }
  std::uint32_t link() const { return kind->link; }
  std::uint32_t collision() const { return kind->collision; }
  const Eigen::Vector3d& color() const { return kind->color; }
};

/// The kinds of solids that the models of a world have. Copies share them.
class SolidKinds {
 public:
  /// Returns those of the model's collisions, links in their order. `index`: of the model in its world.
  const std::vector<SolidKindPtr>& of_model(std::size_t index, const description::Model& model);

 private:
  using MeshKey = std::pair<const description::TriangleMesh*, bool>;  // the bool: convex

  std::vector<std::shared_ptr<const std::vector<SolidKindPtr>>> by_model_;  // null: nobody has asked yet
  std::map<MeshKey, std::shared_ptr<const MeshSurface>> meshes_;
};

}  // namespace cohort::geometry
