// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/shapes/mesh_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "server/core/infinity.hpp"
#include "server/geometry/shapes/convex_hull.hpp"

namespace cohort::geometry {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<std::uint32_t, 3>;

constexpr std::uint32_t triangles_a_leaf = 4;
constexpr std::size_t deepest = 64;  // the tree is halved at every level

// Boxes are entered slightly early, so that rounding cannot lose a triangle [m].
constexpr double slack = 1e-9;

Bounds bounds_round(const std::vector<Vector3d>& vertices, const Triangle& triangle) {
  const Vector3d &a = vertices[triangle[0]], &b = vertices[triangle[1]], &c = vertices[triangle[2]];
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

Vector3d scaled_normal(const std::vector<Vector3d>& vertices, const Triangle& triangle) {
  const Vector3d& a = vertices[triangle[0]];
  return (vertices[triangle[1]] - a).cross(vertices[triangle[2]] - a);
}

bool closes_a_surface(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& triangle : triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(triangle[i], triangle[(i + 1) % 3]);
  std::sort(edges.begin(), edges.end());
  return std::adjacent_find(edges.begin(), edges.end()) == edges.end() &&
         std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
           return std::binary_search(edges.begin(), edges.end(), std::pair(edge.second, edge.first));
         });
}

double volume_of(const std::vector<Vector3d>& vertices, const std::vector<Triangle>& triangles) {
  double sixfold = 0.0;
  for (const Triangle& triangle : triangles)
    sixfold += (vertices[triangle[0]] - vertices[triangles[0][0]]).dot(scaled_normal(vertices, triangle));
  return sixfold / 6.0;
}

// Returns the sign of the rotation from p to q about the origin. If both are in line with the origin, it is perturbed
// by an infinitesimal step along x, then by an infinitely smaller one along y. A ray through the common edge of two
// triangles therefore hits exactly one of them.
int turn(const Eigen::Vector2d& p, const Eigen::Vector2d& q, double cross) {
  if (cross != 0.0) return cross > 0.0 ? 1 : -1;
  if (p.y() != q.y()) return p.y() > q.y() ? 1 : -1;
  if (p.x() != q.x()) return q.x() > p.x() ? 1 : -1;
  return 0;
}

}  // namespace

// A ray in the form of Woop, Benthin, Wald, "Watertight ray/triangle intersection", Journal of Computer Graphics
// Techniques 2(1), 2013. The axes are permuted and sheared so that the ray runs along the third axis from the origin.
struct MeshSurface::Ray {
  Ray(const Vector3d& from, const Vector3d& along) : origin(from), direction(along) {
    along.cwiseAbs().maxCoeff(&z);
    x = (z + 1) % 3;
    y = (z + 2) % 3;
    if (along[z] < 0.0) std::swap(x, y);
    shear = Vector3d(along[x], along[y], 1.0) / along[z];
  }

  Vector3d sheared(const Vector3d& point) const {
    const Vector3d p = point - origin;
    return {p[x] - shear.x() * p[z], p[y] - shear.y() * p[z], shear.z() * p[z]};
  }

  /// Returns the distance at which the ray enters a box; infinite if it misses.
  double enter(const Bounds& box) const {
    double first = 0.0;
    double last = infinity;
    for (int axis = 0; axis < 3; ++axis) {
      const double to_lower = box.lower[axis] - slack - origin[axis];
      const double to_upper = box.upper[axis] + slack - origin[axis];
      if (direction[axis] == 0.0) {
        if (to_lower > 0.0 || to_upper < 0.0) return infinity;
        continue;
      }
      const double a = to_lower / direction[axis];
      const double b = to_upper / direction[axis];
      first = std::max(first, std::min(a, b));
      last = std::min(last, std::max(a, b));
    }
    if (first > last) return infinity;
    return first;
  }

  const Vector3d& origin;
  const Vector3d& direction;
  int x = 0, y = 0, z = 0;
  Vector3d shear;
};

struct MeshSurface::Crossing {
  int side = 0;  // 1 through the front, -1 through the back, 0 if it misses
  double distance = infinity;
};

MeshSurface::MeshSurface(const description::Mesh& mesh) {
  if (mesh.convex)
    make_half_spaces(geometry::convex_hull(mesh.triangles->vertices));
  else
    make_tree(*mesh.triangles);
}

void MeshSurface::make_half_spaces(const description::TriangleMesh& hull) {
  is_closed_ = true;
  const auto count = static_cast<Eigen::Index>(hull.vertices.size());
  Eigen::ArrayX3d vertices(count, 3);  // a column for each coordinate, for vector instructions
  for (Eigen::Index i = 0; i < count; ++i) vertices.row(i) = hull.vertices[static_cast<std::size_t>(i)].transpose();
  half_spaces_.reserve(hull.triangles.size());
  for (const Triangle& triangle : hull.triangles) {
    const Vector3d normal = scaled_normal(hull.vertices, triangle).normalized();
    // In the order of Vector3d::dot(), which has the same bits.
    const auto along = (normal.x() * vertices.col(0) + normal.y() * vertices.col(1)) + normal.z() * vertices.col(2);
    half_spaces_.push_back({normal, along.maxCoeff()});
  }
}

void MeshSurface::make_tree(const description::TriangleMesh& mesh) {
  vertices_ = mesh.vertices;
  triangles_ = mesh.triangles;
  is_closed_ = closes_a_surface(triangles_);
  if (is_closed_ && volume_of(vertices_, triangles_) < 0.0) outward_ = -1.0;

  std::vector<Bounds> boxes;
  boxes.reserve(triangles_.size());
  for (const Triangle& triangle : triangles_) boxes.push_back(bounds_round(vertices_, triangle));
  for (std::uint32_t i = 0; i < triangles_.size(); ++i)
    if (scaled_normal(vertices_, triangles_[i]) != Vector3d::Zero()) order_.push_back(i);
  if (order_.empty()) return;

  struct Part {
    std::uint32_t begin, end;
    std::uint32_t parent;  // node of which it is the second child
  };
  constexpr std::uint32_t none = 0xffffffffu;
  std::vector<Part> waiting{{0, static_cast<std::uint32_t>(order_.size()), none}};
  while (!waiting.empty()) {
    const Part part = waiting.back();
    waiting.pop_back();
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    if (part.parent != none) nodes_[part.parent].first = index;
    Node& node = nodes_.emplace_back();
    node.box = {Vector3d::Constant(infinity), Vector3d::Constant(-infinity)};
    for (std::uint32_t i = part.begin; i < part.end; ++i) {
      node.box.lower = node.box.lower.cwiseMin(boxes[order_[i]].lower);
      node.box.upper = node.box.upper.cwiseMax(boxes[order_[i]].upper);
    }
    if (part.end - part.begin <= triangles_a_leaf) {
      node.first = part.begin;
      node.count = part.end - part.begin;
      continue;
    }
    int axis = 0;
    (node.box.upper - node.box.lower).maxCoeff(&axis);
    const std::uint32_t middle = part.begin + (part.end - part.begin) / 2;
    std::nth_element(order_.begin() + part.begin, order_.begin() + middle, order_.begin() + part.end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const double at_a = boxes[a].lower[axis] + boxes[a].upper[axis];
                       const double at_b = boxes[b].lower[axis] + boxes[b].upper[axis];
                       return at_a != at_b ? at_a < at_b : a < b;
                     });
    waiting.push_back({middle, part.end, index});
    waiting.push_back({part.begin, middle, none});
  }
}

template <class Visit>
void MeshSurface::for_each_along(const Ray& ray, double range, Visit&& visit) const {
  std::array<std::uint32_t, deepest> waiting{};
  std::size_t size = 0;
  waiting[size++] = 0;
  double end = range;
  while (size > 0) {
    const std::uint32_t index = waiting[--size];
    const Node& node = nodes_[index];
    if (!(ray.enter(node.box) <= end)) continue;
    for (std::uint32_t i = 0; i < node.count; ++i) end = visit(order_[node.first + i]);
    if (node.count > 0) continue;
    waiting[size++] = node.first;
    waiting[size++] = index + 1;
  }
}

Vector3d MeshSurface::normal_of(std::uint32_t triangle) const {
  return outward_ * scaled_normal(vertices_, triangles_[triangle]).normalized();
}

MeshSurface::Crossing MeshSurface::cross(const Ray& ray, std::uint32_t triangle) const {
  const Vector3d a = ray.sheared(vertices_[triangles_[triangle][0]]);
  const Vector3d b = ray.sheared(vertices_[triangles_[triangle][1]]);
  const Vector3d c = ray.sheared(vertices_[triangles_[triangle][2]]);
  const double u = b.x() * c.y() - b.y() * c.x();
  const double v = c.x() * a.y() - c.y() * a.x();
  const double w = a.x() * b.y() - a.y() * b.x();
  const int side = turn(b.head<2>(), c.head<2>(), u);
  if (side == 0 || turn(c.head<2>(), a.head<2>(), v) != side || turn(a.head<2>(), b.head<2>(), w) != side) return {};
  const double area = u + v + w;
  if (area == 0.0) return {};
  // The axes keep their handedness: seen along the ray, a front face is clockwise.
  return {outward_ > 0.0 ? -side : side, (u * a.z() + v * b.z() + w * c.z()) / area};
}

bool MeshSurface::is_inside(const Ray& ray) const {
  if (!is_closed_ || !((ray.origin - nodes_[0].box.lower).array() >= 0.0).all() ||
      !((nodes_[0].box.upper - ray.origin).array() >= 0.0).all())
    return false;
  int left = 0;  // number of solids that the ray leaves minus those that it enters
  for_each_along(ray, infinity, [&](std::uint32_t triangle) {
    const Crossing crossing = cross(ray, triangle);
    if (crossing.side != 0 && crossing.distance >= 0.0) left -= crossing.side;
    return infinity;
  });
  return left > 0;
}

RayEntry MeshSurface::cast_ray(const Vector3d& origin, const Vector3d& direction, double range) const {
  if (!half_spaces_.empty()) return enter_convex(origin, direction);
  if (nodes_.empty()) return {};
  const Ray ray(origin, direction);
  if (is_inside(ray)) return {0.0, Vector3d::Zero()};
  RayEntry best;
  std::uint32_t met = 0;
  for_each_along(ray, range, [&](std::uint32_t triangle) {
    const Crossing crossing = cross(ray, triangle);
    const bool enters = crossing.side > 0 || (crossing.side < 0 && !is_closed_);
    if (enters && crossing.distance >= 0.0 &&
        (crossing.distance < best.distance || (crossing.distance == best.distance && triangle < met))) {
      best.distance = crossing.distance;
      met = triangle;
    }
    return std::min(range, best.distance);
  });
  if (best.distance > range) return {};
  best.normal = normal_of(met);
  if (best.normal.dot(direction) > 0.0) best.normal = -best.normal;  // for an open surface, the side that is hit
  return best;
}

RayEntry MeshSurface::enter_convex(const Vector3d& origin, const Vector3d& direction) const {
  double first = -infinity;
  double last = infinity;
  Vector3d normal = Vector3d::Zero();
  for (const HalfSpace& half_space : half_spaces_) {
    const double height = half_space.normal.dot(origin) - half_space.offset;
    const double climb = half_space.normal.dot(direction);
    if (climb == 0.0) {
      if (height > 0.0) return {};
      continue;
    }
    const double distance = -height / climb;
    if (climb > 0.0) {
      last = std::min(last, distance);
    } else if (distance > first) {
      first = distance;
      normal = half_space.normal;
    }
  }
  if (first > last || last < 0.0) return {};
  if (first <= 0.0) return {0.0, Vector3d::Zero()};
  return {first, normal};
}

}  // namespace cohort::geometry
