// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/geometry/shapes/bounds.hpp"

namespace cohort::geometry {

/// A mesh prepared for ray casting: the planes around a convex mesh, or a tree of boxes over the triangles of any
/// other. Made once for all solids of the same mesh. Const, and callable from any thread.
class MeshSurface {
 public:
  /// Throws std::invalid_argument if the mesh is convex and spans no volume.
  explicit MeshSurface(const description::Mesh& mesh);

  /// Returns where a ray enters, at most at `range`. The rules of cast_ray of a Shape apply; of two triangles at
  /// exactly the same distance, the one with the lower index is hit.
  RayEntry cast_ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double range) const;

  /// Returns whether the surface is closed: each edge belongs to two triangles, in opposite directions.
  bool is_closed() const { return is_closed_; }

 private:
  struct HalfSpace {
    Eigen::Vector3d normal;  // unit, outward
    double offset;           // position of the plane along the normal
  };
  /// A node of the tree, with a box around its triangles. The first child of an inner node is the next node.
  struct Node {
    Bounds box;
    std::uint32_t first = 0;  // leaf: first entry in `order_`; inner node: second child
    std::uint32_t count = 0;  // leaf: number of triangles; inner node: 0
  };
  struct Ray;
  struct Crossing;

  void make_half_spaces(const description::TriangleMesh& hull);
  void make_tree(const description::TriangleMesh& mesh);
  RayEntry enter_convex(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  bool is_inside(const Ray& ray) const;
  Crossing cross(const Ray& ray, std::uint32_t triangle) const;
  /// Calls `visit(triangle)` for all triangles that a ray may hit; `visit` returns the distance at which the search may
  /// end.
  template <class Visit>
  void for_each_along(const Ray& ray, double range, Visit&& visit) const;
  Eigen::Vector3d normal_of(std::uint32_t triangle) const;

  std::vector<HalfSpace> half_spaces_;  // for a convex mesh, which has no tree
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Node> nodes_;  // the root first
  std::vector<std::uint32_t> order_;
  bool is_closed_ = false;
  double outward_ = 1.0;  // -1 if the triangles of a closed mesh are clockwise seen from outside
};

}  // namespace cohort::geometry
