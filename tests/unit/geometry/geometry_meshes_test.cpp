// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "server/core/infinity.hpp"
#include "server/geometry/shapes/mesh_surface.hpp"
#include "tests/support/worlds/random_scene.hpp"

// Meshes and height maps, which are neither centred nor described by a few numbers.
namespace cohort::geometry {
namespace {

using description::HeightGrid;
using description::Heightmap;
using description::Mesh;
using description::TriangleMesh;
using Eigen::Vector3d;

Mesh mesh_of(TriangleMesh triangles, bool convex) {
  return {std::make_shared<const TriangleMesh>(std::move(triangles)), convex};
}

TriangleMesh box(const Vector3d& size) {
  std::vector<Vector3d> corners;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5}) corners.push_back(Vector3d(x, y, z).cwiseProduct(size));
  return geometry::convex_hull(corners);
}

// Returns a lying ring like a tyre: a closed surface that is far from convex.
constexpr double ring_radius = 1.0, tube_radius = 0.4;
TriangleMesh torus(int around, int across) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double r = ring_radius + tube_radius * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v));
      const auto at = [&](int k, int l) { return static_cast<std::uint32_t>((k % around) * across + l % across); };
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

// Casts the ray by Moeller and Trumbore's test of every triangle: an independent algorithm.
RayEntry first_triangle(const TriangleMesh& mesh, const Vector3d& origin, const Vector3d& direction) {
  RayEntry first;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d ab = mesh.vertices[b] - mesh.vertices[a], ac = mesh.vertices[c] - mesh.vertices[a];
    const Vector3d p = direction.cross(ac), t = origin - mesh.vertices[a], q = t.cross(ab);
    const double det = ab.dot(p), u = t.dot(p) / det, v = direction.dot(q) / det, distance = ac.dot(q) / det;
    if (u < 0 || v < 0 || u + v > 1 || distance < 0 || distance >= first.distance) continue;
    first = {distance, ab.cross(ac).normalized()};
  }
  return first;
}

TEST(MeshRay, AgreesWithATestOfEveryTriangle) {
  const TriangleMesh mesh = torus(40, 24);
  const MeshSurface surface(mesh_of(mesh, false));
  EXPECT_TRUE(surface.is_closed());
  const RandomStream random(21, "geometry_test", "mesh");
  int hits = 0, inside = 0;
  for (std::uint64_t n = 0; n < 3000; ++n) {
    const Vector3d origin = random_vector(random, n, 1.6);
    const Vector3d direction = random_vector(random, n + 10'000, 1.0).normalized();
    const RayEntry found = surface.cast_ray(origin, direction, infinity);
    const RayEntry expected = first_triangle(mesh, origin, direction);
    if (std::isfinite(expected.distance) && expected.normal.dot(direction) > 0.0) {
      EXPECT_EQ(found.distance, 0.0) << n << ": it starts inside";
      ++inside;
    } else if (std::isinf(expected.distance)) {
      EXPECT_TRUE(std::isinf(found.distance)) << n;
    } else {
      EXPECT_NEAR(found.distance, expected.distance, 1e-12) << n;
      EXPECT_LT((found.normal - expected.normal).norm(), 1e-12) << n;
      ++hits;
    }
  }
  EXPECT_GT(hits, 400);
  EXPECT_GT(inside, 100);
}

TEST(MeshRay, NeverMissesAtAnEdgeOrACorner) {
  const TriangleMesh mesh = torus(12, 8);
  const MeshSurface surface(mesh_of(mesh, false));
  const RandomStream random(22, "geometry_test", "edges");
  for (std::uint64_t n = 0; n < 2000; ++n) {
    const auto& triangle = mesh.triangles[n % mesh.triangles.size()];
    const double share = n % 3 == 0 ? 0.0 : random.uniform(n, 0);
    const Vector3d target = (1 - share) * mesh.vertices[triangle[0]] + share * mesh.vertices[triangle[1]];
    const Vector3d inside =
        ring_radius * Vector3d(target.x(), target.y(), 0.0).normalized() * std::cos(std::numbers::pi / 12);
    // From outside towards a point in the tube, through the edge.
    const Vector3d direction = (inside - target).normalized();
    const Vector3d origin = target - 0.01 * direction;
    EXPECT_NEAR(surface.cast_ray(origin, direction, infinity).distance, 0.01, 1e-9) << n;
    EXPECT_EQ(surface.cast_ray(target + 1e-6 * direction, direction, infinity).distance, 0.0) << n;
  }
}

TEST(MeshRay, StartsInsideABoxOnlyIfItsOriginIsInside) {
  const MeshSurface surface(mesh_of(box({2, 2, 2}), false));
  EXPECT_EQ(surface.cast_ray({0, 0, 0}, {1, 0, 0}, infinity).distance, 0.0);
  EXPECT_EQ(surface.cast_ray({0.5, 0.5, 0.5}, {1, 0, 0}, infinity).distance, 0.0) << "over a diagonal of a face";
  for (const double y : {-1.0, 0.0, 1.0})
    for (const double z : {-1.0, 0.0, 1.0}) {
      const double distance = surface.cast_ray({-3, y, z}, {1, 0, 0}, infinity).distance;
      EXPECT_TRUE(distance == 2.0 || (std::isinf(distance) && std::abs(y) + std::abs(z) > 0.0))
          << y << " " << z << " " << distance;
    }
}

TEST(MeshRay, HitsAnOpenMeshFromBothSides) {
  const MeshSurface surface(mesh_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, false));
  EXPECT_FALSE(surface.is_closed());
  const RayEntry above = surface.cast_ray({0.2, 0.2, 1}, {0, 0, -1}, infinity);
  EXPECT_DOUBLE_EQ(above.distance, 1.0);
  EXPECT_EQ(above.normal, Vector3d(0, 0, 1));
  const RayEntry below = surface.cast_ray({0.2, 0.2, -1}, {0, 0, 1}, infinity);
  EXPECT_DOUBLE_EQ(below.distance, 1.0);
  EXPECT_EQ(below.normal, Vector3d(0, 0, -1));
  EXPECT_TRUE(std::isinf(surface.cast_ray({0.2, 0.2, 1}, {0, 0, -1}, 0.9).distance)) << "out of range";
}

TEST(MeshRay, EntersAnInvertedMesh) {
  TriangleMesh mesh = box({2, 2, 2});
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  const MeshSurface surface(mesh_of(mesh, false));
  const RayEntry entry = surface.cast_ray({-3, 0.1, 0.2}, {1, 0, 0}, infinity);
  EXPECT_DOUBLE_EQ(entry.distance, 2.0);
  EXPECT_LT((entry.normal - Vector3d(-1, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(surface.cast_ray({0, 0.1, 0.2}, {1, 0, 0}, infinity).distance, 0.0);
}

TEST(MeshRay, OnAConvexMeshAgreesWithTheClosedForm) {
  const Vector3d size(1.0, 0.6, 0.4);
  const MeshSurface hull(mesh_of(box(size), true)), skin(mesh_of(box(size), false));
  const RandomStream random(23, "geometry_test", "convex");
  int hits = 0;
  for (std::uint64_t n = 0; n < 1000; ++n) {
    const Vector3d origin = random_vector(random, n, 1.0);
    const Vector3d direction = (random_vector(random, n + 5000, 0.3) - origin).normalized();
    const RayEntry expected = cast_ray(description::Box{size}, origin, direction);
    for (const MeshSurface* const surface : {&hull, &skin}) {
      const RayEntry found = surface->cast_ray(origin, direction, infinity);
      ASSERT_EQ(std::isinf(found.distance), std::isinf(expected.distance)) << n;
      if (std::isinf(expected.distance)) continue;
      EXPECT_NEAR(found.distance, expected.distance, 1e-12) << n;
      EXPECT_LT((found.normal - expected.normal).norm(), 1e-12) << n;
      ++hits;
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(MeshRay, UsesTheHullOfAConvexMesh) {
  TriangleMesh points;
  points.vertices = box({2, 2, 2}).vertices;
  EXPECT_DOUBLE_EQ(cast_ray(mesh_of(points, true), {-3, 0, 0}, {1, 0, 0}).distance, 2.0);
  EXPECT_EQ(cast_ray(mesh_of(points, true), {0, 0, 0}, {1, 0, 0}).distance, 0.0);
}

// ---- Height maps ----

HeightGrid hills() {
  HeightGrid grid{9, 6, {0.5, 0.4}, {}};
  const RandomStream random(24, "geometry_test", "hills");
  for (std::uint64_t n = 0; n < 54; ++n) grid.heights.push_back(random.uniform(n, 0));
  return grid;
}

// Returns the two triangles of each cell, as defined by Heightmap.
TriangleMesh triangles_of(const HeightGrid& grid) {
  TriangleMesh mesh;
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column) {
      mesh.vertices.emplace_back(static_cast<double>(column) * grid.spacing.x() - grid.half_size().x(),
                                 static_cast<double>(row) * grid.spacing.y() - grid.half_size().y(),
                                 grid.height(column, row));
      if (row + 1 == grid.rows || column + 1 == grid.columns) continue;
      const auto a = static_cast<std::uint32_t>(row * grid.columns + column),
                 up = static_cast<std::uint32_t>(a + grid.columns);
      mesh.triangles.push_back({a, a + 1, up});
      mesh.triangles.push_back({a + 1, up + 1, up});
    }
  return mesh;
}

Heightmap map_of(const HeightGrid& grid) { return {std::make_shared<const HeightGrid>(grid)}; }

TEST(HeightmapRay, AgreesWithATestOfEveryTriangle) {
  const HeightGrid grid = hills();
  const TriangleMesh mesh = triangles_of(grid);
  const RandomStream random(25, "geometry_test", "heightmap");
  int hits = 0, inside = 0, over = 0;
  for (std::uint64_t n = 0; n < 4000; ++n) {
    const Vector3d origin(3.8 * random.uniform(n, 0) - 1.9, 1.9 * random.uniform(n, 1) - 0.95,
                          1.5 * random.uniform(n, 2));
    const Vector3d direction = random_vector(random, n + 10'000, 1.0).normalized();
    const RayEntry found = cast_ray(map_of(grid), origin, direction);
    if (std::isinf(first_triangle(mesh, origin, {0, 0, -1}).distance)) {
      EXPECT_EQ(found.distance, 0.0) << n << ": it starts below";
      ++inside;
      continue;
    }
    const RayEntry expected = first_triangle(mesh, origin, direction);
    if (std::isinf(expected.distance)) {
      EXPECT_TRUE(std::isinf(found.distance)) << n;
      ++over;
    } else {
      EXPECT_NEAR(found.distance, expected.distance, 1e-12) << n;
      EXPECT_LT((found.normal - expected.normal).norm(), 1e-9) << n;
      ++hits;
    }
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(inside, 500);
  EXPECT_GT(over, 500);
}

TEST(HeightmapRay, StraightDownHitsEveryCornerLineAndDiagonal) {
  const HeightGrid grid = hills();
  for (std::size_t row = 0; row + 1 < grid.rows; ++row)
    for (std::size_t column = 0; column + 1 < grid.columns; ++column) {
      const Vector3d corner(static_cast<double>(column) * 0.5 - 2.0, static_cast<double>(row) * 0.4 - 1.0, 2.0);
      EXPECT_NEAR(cast_ray(map_of(grid), corner, {0, 0, -1}).distance, 2.0 - grid.height(column, row), 1e-12);
      const double on_diagonal = 0.5 * (grid.height(column + 1, row) + grid.height(column, row + 1));
      EXPECT_NEAR(cast_ray(map_of(grid), corner + Vector3d(0.25, 0.2, 0), {0, 0, -1}).distance, 2.0 - on_diagonal,
                  1e-12);
    }
}

TEST(HeightmapRay, EntersThroughASideAndEndsAtTheEdge) {
  const HeightGrid flat{2, 2, {2, 2}, {1, 1, 1, 1}};
  const RayEntry side = cast_ray(map_of(flat), {-3, 0, 0.5}, {1, 0, 0});
  EXPECT_DOUBLE_EQ(side.distance, 2.0);
  EXPECT_EQ(side.normal, Vector3d(-1, 0, 0));
  EXPECT_TRUE(std::isinf(cast_ray(map_of(flat), {-3, 0, 1.5}, {1, 0, 0}).distance)) << "passes above";
  EXPECT_TRUE(std::isinf(cast_ray(map_of(flat), {-3, 0, 0}, {0, 0, -1}).distance)) << "beside it is nothing";
  EXPECT_TRUE(std::isinf(cast_ray(map_of(flat), {0, 0, 3}, {0, 0, -1}, 1.9).distance)) << "out of range";
  EXPECT_EQ(cast_ray(map_of(flat), {0, 0, -100}, {0, 0, 1}).distance, 0.0) << "all below is solid";
}

// ---- In the scene ----

TEST(Bounds, OfMeshesAndHeightmapsAreTight) {
  const Pose lying{{1, 2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Vector3d::UnitZ()))};
  const Bounds mesh = bounds_of(mesh_of(torus(40, 24), false), lying);
  EXPECT_NEAR(mesh.upper.z(), 3.0 + tube_radius, 1e-12);
  EXPECT_NEAR(mesh.lower.x(), 1.0 - ring_radius - tube_radius, 0.01);
  const Bounds map = bounds_of(map_of({2, 2, {2, 2}, {0, 0, 1, 0}}), lying);
  EXPECT_DOUBLE_EQ(map.upper.z(), 4.0);
  EXPECT_EQ(map.lower.z(), -infinity);
  EXPECT_NEAR(map.upper.x(), 1.0 + std::cos(0.5) + std::sin(0.5), 1e-12);
  const Pose tilted{{0, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Vector3d::UnitY()))};
  EXPECT_EQ(bounds_of(map_of({2, 2, {2, 2}, {0, 0, 1, 0}}), tilted).lower.x(), -infinity);
}

TEST(SolidKinds, AreMadeOnceForEachCollisionAndShareTheSurfaceOfAMesh) {
  description::Model model;
  const Mesh mesh = mesh_of(torus(20, 12), false);
  for (int link = 0; link < 2; ++link) {
    model.links.emplace_back();
    for (int i = 0; i < 2; ++i) model.links.back().collisions.push_back({"", {}, mesh, {}});
  }
  model.links[1].collisions[0].shape = description::Sphere{0.1};
  SolidKinds kinds;
  const std::vector<SolidKindPtr> of_model = kinds.of_model(1, model);
  ASSERT_EQ(of_model.size(), 4u);
  EXPECT_EQ(of_model[2]->link, 1u);
  EXPECT_EQ(of_model[3]->collision, 1u);
  EXPECT_EQ(of_model[0]->mesh, of_model[3]->mesh);
  EXPECT_EQ(of_model[2]->mesh, nullptr);
  SolidKinds copy = kinds;
  EXPECT_EQ(copy.of_model(1, model), of_model);
  EXPECT_EQ(copy.of_model(0, model)[0]->mesh, of_model[0]->mesh);
}

TEST(MeshScene, HasTheBitsOfEachSolidAlone) {
  const Mesh skin = mesh_of(torus(20, 12), false), hull = mesh_of(box({0.3, 0.2, 0.1}), true);
  const RandomStream random(26, "geometry_test", "scene");
  Scene scene;
  for (std::uint32_t n = 0; n < 60; ++n) {
    const Shape shape = n % 3 == 0 ? Shape(skin) : n % 3 == 1 ? Shape(hull) : Shape(map_of(hills()));
    const Vector3d axis = n % 3 == 2 ? Vector3d(Vector3d::UnitZ()) : random_vector(random, n + 100, 1.0).normalized();
    scene.add({shape,
               {},
               BodyId{n},
               n % 3 == 1,
               {random_vector(random, n, 4.0), Eigen::Quaterniond(Eigen::AngleAxisd(n, axis))}});
  }
  scene.build();
  int hits = 0;
  for (std::uint64_t n = 0; n < 400; ++n) {
    const Vector3d origin = random_vector(random, n + 1000, 5.0),
                   direction = random_vector(random, n + 2000, 1.0).normalized();
    RayEntry nearest;
    std::optional<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < scene.size(); ++i) {
      const Pose X_CW = scene.solid(i).X_WC.inverse();
      const RayEntry entry = cast_ray(scene.solid(i).shape(), X_CW * origin, X_CW.orientation * direction);
      if (entry.distance <= 1.5 && entry.distance < nearest.distance) {
        nearest = entry;
        expected = i;
      }
    }
    const auto hit = scene.cast_ray(origin, direction, 1.5);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << n;
    if (!hit) continue;
    EXPECT_EQ(hit->solid, expected) << n;
    EXPECT_EQ(hit->distance, nearest.distance) << n;
    ++hits;
  }
  EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace cohort::geometry
