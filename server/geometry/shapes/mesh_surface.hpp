#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/geometry/shapes/bounds.hpp"

namespace cohort::geometry {

/// A mesh made ready for rays: the planes round a convex one, a tree of boxes over the triangles of any other. Made
/// once for all solids of the same mesh; const, and callable from any thread.
class MeshSurface {
 public:
  /// Throws std::invalid_argument if the mesh is convex and spans no volume.
  explicit MeshSurface(const description::Mesh& mesh);

  /// Where a ray enters, no further than `range`. The rules of cast_ray of a Shape hold; of two triangles at the very
  /// same distance, the one with the lower index.
  RayEntry cast_ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double range) const;

  /// Whether the triangles close a surface: each edge belongs to two of them, in opposite directions.
  bool is_closed() const { return is_closed_; }

 private:
  struct HalfSpace {
    Eigen::Vector3d normal;  // unit, outward
    double offset;           // of the plane, along the normal
  };
  /// A box round triangles: the two children's, the first of which is the next node, or of a leaf its own.
  struct Node {
    Bounds box;
    std::uint32_t first = 0;  // of a leaf's entries in `order_`; of others, the second child
    std::uint32_t count = 0;  // of a leaf's triangles; 0 if it is none
  };
  struct Ray;
  struct Crossing;

  void make_half_spaces(const description::TriangleMesh& hull);
  void make_tree(const description::TriangleMesh& mesh);
  RayEntry enter_convex(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  bool is_inside(const Ray& ray) const;
  Crossing cross(const Ray& ray, std::uint32_t triangle) const;
  /// Calls `visit(triangle)` for all that a ray may meet; it returns how far the search may end.
  template <class Visit>
  void for_each_along(const Ray& ray, double range, Visit&& visit) const;
  Eigen::Vector3d normal_of(std::uint32_t triangle) const;

  std::vector<HalfSpace> half_spaces_;  // of a convex mesh; then there is no tree
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Node> nodes_;  // the root first
  std::vector<std::uint32_t> order_;
  bool is_closed_ = false;
  double outward_ = 1.0;  // -1 if the triangles of a closed mesh are clockwise seen from outside
};

}  // namespace cohort::geometry
