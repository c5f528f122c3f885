// SPDX-License-Identifier: Apache-2.0
#include "server/placement/occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "server/core/infinity.hpp"
#include "server/core/plane_vectors.hpp"

namespace cohort::placement {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double negligible_cell = 1e-3;  // [m]

// If the z component of a normal is below this fraction of its length, the surface is vertical and does not count as
// ground.
constexpr double upright = 1e-9;

// Returns the height of the triangle at the point; nothing if the point is outside of its projection.
std::optional<double> height_at(const Triangle& t, const Vector2d& point) {
  const Vector2d a = t[0].head<2>(), b = t[1].head<2>(), c = t[2].head<2>();
  const double area = cross(b - a, c - a);
  if (area == 0.0) return std::nullopt;
  const double u = cross(c - b, point - b) / area;
  const double v = cross(a - c, point - c) / area;
  const double w = 1.0 - u - v;
  if (u < 0.0 || v < 0.0 || w < 0.0) return std::nullopt;
  return u * t[0].z() + v * t[1].z() + w * t[2].z();
}

double distance_to_segment(const Vector2d& from, const Vector2d& to, const Vector2d& point) {
  const Vector2d along = to - from;
  const double length = along.squaredNorm();
  const double share = length > 0.0 ? std::clamp((point - from).dot(along) / length, 0.0, 1.0) : 0.0;
  return (point - from - share * along).norm();
}

// Returns the part of a convex polygon on one side of a height: above it if `sign` is 1, below it if -1.
std::vector<Vector3d> cut(const std::vector<Vector3d>& polygon, double height, double sign) {
  std::vector<Vector3d> rest;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& from = polygon[i];
    const Vector3d& to = polygon[(i + 1) % polygon.size()];
    const double above_from = sign * (from.z() - height);
    const double above_to = sign * (to.z() - height);
    if (above_from >= 0.0) rest.push_back(from);
    if ((above_from < 0.0) != (above_to < 0.0))
      rest.push_back(from + above_from / (above_from - above_to) * (to - from));
  }
  return rest;
}

// Returns whether each edge belongs to two triangles with opposite directions along it.
bool is_closed(const TriangleMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(triangle[i], triangle[(i + 1) % 3]);
  std::ranges::sort(edges);
  return std::ranges::adjacent_find(edges) == edges.end() && std::ranges::all_of(edges, [&](const auto& edge) {
           return std::ranges::binary_search(edges, std::pair(edge.second, edge.first));
         });
}

}  // namespace

std::optional<double> highest_on_disc(const Triangle& triangle, const Vector2d& centre, double radius) {
  std::optional<double> highest;
  const auto take = [&](double z) { highest = std::max(highest.value_or(-infinity), z); };
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& from = triangle[i];
    const Vector3d& to = triangle[(i + 1) % 3];
    if ((from.head<2>() - centre).norm() <= radius) take(from.z());
    // Intersections of the edge with the circle.
    const Vector2d along = (to - from).head<2>();
    const Vector2d offset = from.head<2>() - centre;
    const double a = along.squaredNorm(), b = along.dot(offset), c = offset.squaredNorm() - radius * radius;
    const double discriminant = b * b - a * c;
    if (a == 0.0 || discriminant < 0.0) continue;
    for (const double sign : {-1.0, 1.0})
      if (const double share = (-b + sign * std::sqrt(discriminant)) / a; share >= 0.0 && share <= 1.0)
        take(from.z() + share * (to.z() - from.z()));
  }
  if (const auto middle = height_at(triangle, centre)) take(*middle);
  // The point of the disc that is farthest up the slope from the centre.
  const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double slope = normal.head<2>().norm();
  if (slope > upright * std::abs(normal.z()) && std::abs(normal.z()) > upright * slope) {
    const double sense = normal.z() > 0.0 ? -1.0 : 1.0;
    if (const auto edge = height_at(triangle, centre + sense * radius / slope * normal.head<2>())) take(*edge);
  }
  return highest;
}

double distance_between_heights(const Triangle& triangle, double lowest, double highest, const Vector2d& point) {
  const std::vector<Vector3d> between = cut(cut({triangle.begin(), triangle.end()}, lowest, 1.0), highest, -1.0);
  if (between.empty()) return infinity;
  double nearest = infinity;
  bool left_of_all = true, right_of_all = true;
  for (std::size_t i = 0; i < between.size(); ++i) {
    const Vector2d from = between[i].head<2>();
    const Vector2d to = between[(i + 1) % between.size()].head<2>();
    nearest = std::min(nearest, distance_to_segment(from, to, point));
    const double side = cross(to - from, point - from);
    left_of_all = left_of_all && side > 0.0;
    right_of_all = right_of_all && side < 0.0;
  }
  return left_of_all || right_of_all ? 0.0 : nearest;
}

void Occupancy::add(const Model& model, const Pose& X_WM) {
  for (const Link& link : model.links) {
    for (const Collision& collision : link.collisions) {
      const Pose X_WC = X_WM * link.X_ML * collision.X_LC;
      if (const auto* const plane = std::get_if<Plane>(&collision.shape)) {
        planes_.push_back({X_WC.position, X_WC.orientation * plane->normal});
      } else if (const auto* const map = std::get_if<Heightmap>(&collision.shape)) {
        add_heights(map->grid, X_WC);
      } else if (const auto* const mesh = std::get_if<description::Mesh>(&collision.shape);
                 mesh != nullptr && !mesh->convex) {
        add_mesh(*mesh->triangles, X_WC);
      } else if (const auto footprint = geometry::footprint_of(collision.shape, X_WC)) {
        Thing& thing = things_.emplace_back();
        thing.footprint = *footprint;
        thing.is_static = model.is_static;
      }
    }
  }
}

void Occupancy::add_heights(const std::shared_ptr<const HeightGrid>& grid, const Pose& X_WC) {
  const double lean = (X_WC.orientation * Vector3d::UnitZ()).head<2>().norm();
  const auto [lowest, highest] = std::minmax_element(grid->heights.begin(), grid->heights.end());
  const double farthest = std::max(std::abs(*lowest), std::abs(*highest)) + grid->half_size().norm();
  heights_.push_back({grid, X_WC, X_WC.inverse(), 2.0 * lean * farthest});
}

void Occupancy::add_mesh(const TriangleMesh& mesh, const Pose& X_WC) {
  const std::uint32_t index = next_mesh_++;
  const bool is_closed = placement::is_closed(mesh);
  for (const auto& corners : mesh.triangles) {
    Thing thing;
    thing.mesh = index;
    thing.is_closed = is_closed;
    thing.is_static = true;
    for (std::size_t i = 0; i < 3; ++i) thing.triangle[i] = X_WC * mesh.vertices[corners[i]];
    const Triangle& t = thing.triangle;
    const Vector3d lower = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
    const Vector3d upper = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    thing.footprint.centre = 0.5 * (lower + upper).head<2>();
    thing.footprint.half = 0.5 * (upper - lower).head<2>();
    thing.footprint.lowest = lower.z();
    thing.footprint.highest = upper.z();
    things_.push_back(thing);
  }
}

std::optional<double> Occupancy::terrain(const Vector2d& centre, double radius) const {
  std::optional<double> highest;
  const auto take = [&](double z) { highest = std::max(highest.value_or(-infinity), z); };
  for (const PlacedPlane& plane : planes_) {
    const Vector3d& n = plane.normal_W;
    if (n.z() < upright) continue;
    take(plane.point_W.z() - n.head<2>().dot(centre - plane.point_W.head<2>()) / n.z() +
         radius * n.head<2>().norm() / n.z());
  }
  for (const PlacedHeights& map : heights_) {
    // The column over the disc, in the frame of the map. For a tilted map, it includes everything that may be under the
    // disc.
    const HeightGrid& grid = *map.grid;
    const Vector3d middle = map.X_CW * Vector3d(centre.x(), centre.y(), map.X_WC.position.z());
    const double reach = radius + map.sway;
    const auto columns = static_cast<double>(grid.columns - 1), rows = static_cast<double>(grid.rows - 1);
    const auto cell = [](double offset, double spacing, double count) {
      return std::floor(std::clamp(offset / spacing, 0.0, count - 1.0));
    };
    const Vector2d offset = middle.head<2>() + grid.half_size();
    if (((offset.array() + reach) < 0.0).any() || ((offset.array() - reach) > 2.0 * grid.half_size().array()).any())
      continue;
    const auto corner = [&](std::size_t column, std::size_t row) {
      return Vector3d(map.X_WC * Vector3d(static_cast<double>(column) * grid.spacing.x() - grid.half_size().x(),
                                          static_cast<double>(row) * grid.spacing.y() - grid.half_size().y(),
                                          grid.height(column, row)));
    };
    const auto first_row = static_cast<std::size_t>(cell(offset.y() - reach, grid.spacing.y(), rows));
    const auto last_row = static_cast<std::size_t>(cell(offset.y() + reach, grid.spacing.y(), rows));
    const auto first_column = static_cast<std::size_t>(cell(offset.x() - reach, grid.spacing.x(), columns));
    const auto last_column = static_cast<std::size_t>(cell(offset.x() + reach, grid.spacing.x(), columns));
    for (std::size_t row = first_row; row <= last_row; ++row)
      for (std::size_t column = first_column; column <= last_column; ++column) {
        const Vector3d east = corner(column + 1, row), north = corner(column, row + 1);
        for (const Vector3d& third : {corner(column, row), corner(column + 1, row + 1)})
          if (const auto z = highest_on_disc({east, north, third}, centre, radius)) take(*z);
      }
  }
  return highest;
}

Cells::Cells(const Vector2d& lower, const Vector2d& upper, double reach, std::size_t expected)
    : lower_(lower), upper_(upper), reach_(reach) {
  const Vector2d size = upper_ - lower_;
  cell_ = std::max({reach, std::sqrt(size.prod() / static_cast<double>(expected + 1)),
                    size.maxCoeff() / static_cast<double>(expected + 1), negligible_cell});
  // The area may be infinite; then there is one cell.
  const auto cells_along = [&](double length) {
    return std::isfinite(length) ? 1 + static_cast<std::size_t>(length / cell_) : 1;
  };
  columns_ = cells_along(size.x());
  rows_ = cells_along(size.y());
}

}  // namespace cohort::placement
