// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "server/core/infinity.hpp"
#include "server/geometry/scene/ray_fan.hpp"
#include "tests/support/worlds/random_scene.hpp"

namespace cohort::geometry {
namespace {

using Eigen::Vector3d;

Pose turned_pose(const RandomStream& random, std::uint64_t n, double half_width) {
  const Vector3d axis = random_vector(random, n + 1'000'000, 1.0).normalized();
  return {random_vector(random, n, half_width),
          Eigen::Quaterniond(Eigen::AngleAxisd(6.0 * random.uniform(n, 3), axis))};
}

TEST(Ray, EntersABoxThroughTheFaceThatItHitsFirst) {
  const RayEntry entry = cast_ray(description::Box{{2, 4, 6}}, {-5, 1, 2}, {1, 0, 0});
  EXPECT_DOUBLE_EQ(entry.distance, 4.0);
  EXPECT_EQ(entry.normal, Vector3d(-1, 0, 0));
  EXPECT_TRUE(std::isinf(cast_ray(description::Box{{2, 4, 6}}, {-5, 3, 2}, {1, 0, 0}).distance));
  EXPECT_TRUE(std::isinf(cast_ray(description::Box{{2, 4, 6}}, {5, 1, 2}, {1, 0, 0}).distance)) << "it lies behind";
}

TEST(Ray, EntersACylinderThroughItsSideOrItsEnds) {
  const description::Cylinder cylinder{0.5, 2.0};
  const RayEntry side = cast_ray(cylinder, {-2, 0.3, 0.5}, {1, 0, 0});
  EXPECT_NEAR(side.distance, 2.0 - 0.4, 1e-15);
  EXPECT_LT((side.normal - Vector3d(-0.8, 0.6, 0)).norm(), 1e-12);
  const RayEntry top = cast_ray(cylinder, {0.1, 0.2, 3.0}, {0, 0, -1});
  EXPECT_DOUBLE_EQ(top.distance, 2.0);
  EXPECT_EQ(top.normal, Vector3d(0, 0, 1));
  const Vector3d slanted = Vector3d(1, 0, -1).normalized();
  EXPECT_NEAR(cast_ray(cylinder, {-1.2, 0, 2.0}, slanted).distance, std::sqrt(2.0), 1e-12) << "through the top";
  EXPECT_TRUE(std::isinf(cast_ray(cylinder, {-2, 0, 1.5}, {1, 0, 0}).distance)) << "passes above";
}

TEST(Ray, EntersASphereAndAPlane) {
  EXPECT_NEAR(cast_ray(description::Sphere{1.0}, {-3, 0.6, 0}, {1, 0, 0}).distance, 3.0 - 0.8, 1e-15);
  const RayEntry plane = cast_ray(description::Plane{}, {0, 0, 2}, Vector3d(3, 0, -4) / 5.0);
  EXPECT_NEAR(plane.distance, 2.5, 1e-15);
  EXPECT_EQ(plane.normal, Vector3d(0, 0, 1));
}

TEST(Ray, EntersACapsuleThroughItsSideOrItsEnds) {
  const description::Capsule capsule{0.5, 2.0};
  const RayEntry side = cast_ray(capsule, {-2, 0.3, 0.5}, {1, 0, 0});
  EXPECT_NEAR(side.distance, 2.0 - 0.4, 1e-15);
  EXPECT_LT((side.normal - Vector3d(-0.8, 0.6, 0)).norm(), 1e-12);
  const RayEntry top = cast_ray(capsule, {0.3, 0, 3.0}, {0, 0, -1});
  EXPECT_NEAR(top.distance, 3.0 - 1.4, 1e-15);
  EXPECT_LT((top.normal - Vector3d(0.6, 0, 0.8)).norm(), 1e-12);
  EXPECT_NEAR(cast_ray(capsule, {-2, 0, -1.3}, {1, 0, 0}).distance, 2.0 - 0.4, 1e-15) << "beyond the cylinder";
  EXPECT_TRUE(std::isinf(cast_ray(capsule, {-2, 0, 1.6}, {1, 0, 0}).distance)) << "passes above";
}

TEST(Ray, EntersAnEllipsoid) {
  const description::Ellipsoid ellipsoid{{1, 2, 3}};
  const RayEntry side = cast_ray(ellipsoid, {-3, 0, 0}, {1, 0, 0});
  EXPECT_DOUBLE_EQ(side.distance, 2.0);
  EXPECT_EQ(side.normal, Vector3d(-1, 0, 0));
  const RayEntry off_axis = cast_ray(ellipsoid, {-3, 1.2, 0}, {1, 0, 0});
  EXPECT_NEAR(off_axis.distance, 3.0 - 0.8, 1e-12);
  EXPECT_LT((off_axis.normal - Vector3d(-0.8, 1.2 / 4.0, 0).normalized()).norm(), 1e-12);
  EXPECT_TRUE(std::isinf(cast_ray(ellipsoid, {-3, 2.1, 0}, {1, 0, 0}).distance));
}

TEST(Ray, HitsASolidAtOnceFromInside) {
  const std::vector<Shape> shapes = {description::Box{{1, 1, 1}},     description::Sphere{0.5},
                                     description::Cylinder{0.5, 1.0}, description::Plane{},
                                     description::Capsule{0.2, 0.2},  description::Ellipsoid{{0.3, 0.4, 0.5}}};
  for (const Shape& shape : shapes)
    EXPECT_EQ(cast_ray(shape, {0.1, 0.1, -0.1}, {1, 0, 0}).distance, 0.0) << shape.index();
}

// Marches along the ray in small steps and tests whether the point is inside: slow, and independent of the closed
// forms.
double marched_distance(const Shape& shape, const Vector3d& origin, const Vector3d& direction, double range) {
  const auto inside = [&](const Vector3d& p) {
    if (const auto* box = std::get_if<description::Box>(&shape))
      return (p.cwiseAbs().array() <= 0.5 * box->size.array()).all();
    if (const auto* sphere = std::get_if<description::Sphere>(&shape)) return p.norm() <= sphere->radius;
    if (const auto* ellipsoid = std::get_if<description::Ellipsoid>(&shape))
      return p.cwiseQuotient(ellipsoid->radii).norm() <= 1.0;
    if (const auto* capsule = std::get_if<description::Capsule>(&shape)) {
      const double half = 0.5 * capsule->length;
      return (p - Vector3d(0, 0, std::clamp(p.z(), -half, half))).norm() <= capsule->radius;
    }
    const auto& cylinder = std::get<description::Cylinder>(shape);
    return p.head<2>().norm() <= cylinder.radius && std::abs(p.z()) <= 0.5 * cylinder.length;
  };
  for (double d = 0.0; d < range; d += 1e-3)
    if (inside(origin + d * direction)) return d;
  return std::numeric_limits<double>::infinity();
}

TEST(Ray, AgreesWithMarchingAlongItForRandomRays) {
  const RandomStream random(7, "geometry_test", "rays");
  const std::vector<Shape> shapes = {description::Box{{1.0, 0.6, 0.4}}, description::Sphere{0.5},
                                     description::Cylinder{0.4, 0.8}, description::Capsule{0.3, 0.6},
                                     description::Ellipsoid{{0.3, 0.6, 0.4}}};
  int hits = 0;
  for (std::uint64_t n = 0; n < 1000; ++n) {
    const Shape& shape = shapes[n % shapes.size()];
    const Vector3d origin = random_vector(random, n, 2.0);
    const Vector3d direction = (random_vector(random, n + 5000, 0.4) - origin).normalized();
    const double exact = cast_ray(shape, origin, direction).distance;
    const double marched = marched_distance(shape, origin, direction, 4.0);
    if (std::isinf(exact)) {
      EXPECT_TRUE(std::isinf(marched)) << n;
    } else if (!std::isinf(marched)) {  // marching may step over a corner
      EXPECT_NEAR(exact, marched, 2e-3) << n;
      ++hits;
    }
  }
  EXPECT_GT(hits, 500);
}

TEST(Bounds, OfCapsulesAndEllipsoidsAreTight) {
  const RandomStream random(13, "geometry_test", "bounds");
  for (const Shape& shape : {Shape(description::Capsule{0.3, 0.6}), Shape(description::Ellipsoid{{0.3, 0.6, 0.9}})})
    for (std::uint64_t n = 0; n < 10; ++n) {
      const Pose X_WC = turned_pose(random, n, 1.0);
      const Bounds bounds = bounds_of(shape, X_WC);
      for (int axis = 0; axis < 3; ++axis) {
        double highest = -10.0;
        for (std::uint64_t m = 0; m < 4000; ++m) {
          const Vector3d on = Vector3d(random.normal(m, 0), random.normal(m, 1), random.normal(m, 2)).normalized();
          const auto* ellipsoid = std::get_if<description::Ellipsoid>(&shape);
          const Vector3d point = ellipsoid != nullptr ? on.cwiseProduct(ellipsoid->radii).eval()
                                                      : (0.3 * on + Vector3d(0, 0, on.z() > 0 ? 0.3 : -0.3)).eval();
          highest = std::max(highest, (X_WC * point)[axis]);
        }
        EXPECT_LE(highest, bounds.upper[axis] + 1e-12);
        EXPECT_NEAR(highest, bounds.upper[axis], 5e-3);
      }
    }
}

// A metre is 10^9 cells of the smallest size: a search of all of them would not end.
TEST(Grids, FindItemsWithCellsOfAnySize) {
  const RandomStream random(17, "geometry_test", "grids");
  for (int decade = -9; decade <= 3; ++decade) {
    const double edge = std::pow(10.0, decade);
    std::vector<Bounds> bounds;
    std::vector<std::uint32_t> items;
    for (std::uint32_t n = 0; n < 200; ++n) {
      const Vector3d corner = random_vector(random, n, 0.5);
      bounds.push_back({corner, corner + Vector3d::Constant(0.5 * edge)});
      items.push_back(n);
    }
    Grid grid;
    CornerGrid corner_grid;
    grid.set_cell_size(edge);
    corner_grid.set_cell_size(edge);
    grid.build(items, bounds);
    corner_grid.build(items, bounds);
    for (std::uint64_t n = 0; n < 50; ++n) {
      const Vector3d centre = random_vector(random, n + 1000, 0.7);
      const Bounds query = Bounds{centre, centre}.grown_by(0.2);
      std::multiset<std::uint32_t> expected, found, found_by_corners, along, along_corners;
      for (const std::uint32_t item : items)
        if (query.overlaps(bounds[item])) expected.insert(item);
      grid.for_each_overlap(query, bounds, [&](std::uint32_t item) { found.insert(item); });
      corner_grid.for_each_overlap(query, [&](std::uint32_t item) { found_by_corners.insert(item); });
      EXPECT_EQ(found, expected) << edge;
      EXPECT_EQ(found_by_corners, expected) << edge;

      const auto target = static_cast<std::uint32_t>(n);
      const Vector3d direction = (bounds[target].lower + Vector3d::Constant(0.25 * edge) - centre).normalized();
      for (const double range : {100.0, infinity}) {
        grid.for_each_along(centre, direction, range, [&](std::uint32_t item) {
          along.insert(item);
          return range;
        });
        corner_grid.for_each_along(centre, direction, range, [&](std::uint32_t item) {
          along_corners.insert(item);
          return range;
        });
      }
      EXPECT_TRUE(along.contains(target)) << edge;
      EXPECT_TRUE(along_corners.contains(target)) << edge;
    }
  }
}

TEST(Grids, SearchesEndForAnyExtentFiniteOrNot) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double any[] = {0.0, 0.3, -0.3, 1e9, -1e9, 1e15, -1e15, 1e142, -1e300, infinity, -infinity, nan};
  std::vector<Bounds> bounds;
  for (const double lower : any)
    for (const double upper : any)
      for (const double other : {0.0, nan}) {
        if (lower > upper) continue;
        bounds.push_back({{lower, other, 0.0}, {upper, other, 0.1}});
        bounds.push_back({{other, lower, nan}, {other, upper, 0.1}});
      }
  const auto near = static_cast<std::uint32_t>(bounds.size());
  bounds.push_back({{0.1, 0.1, 0.0}, {0.2, 0.2, 0.1}});
  std::vector<std::uint32_t> items(bounds.size());
  std::iota(items.begin(), items.end(), 0u);
  Grid grid;
  CornerGrid corner_grid;
  grid.set_cell_size(0.1);
  corner_grid.set_cell_size(0.1);
  grid.build(items, bounds);
  corner_grid.build(items, bounds);
  for (const Bounds& query : bounds) {
    std::multiset<std::uint32_t> expected, found, found_by_corners;
    for (const std::uint32_t item : items)
      if (query.overlaps(bounds[item])) expected.insert(item);
    grid.for_each_overlap(query, bounds, [&](std::uint32_t item) { found.insert(item); });
    corner_grid.for_each_overlap(query, [&](std::uint32_t item) { found_by_corners.insert(item); });
    EXPECT_EQ(found, expected);
    EXPECT_EQ(found_by_corners, expected);
  }
  for (const double x : any)
    for (const double y : any)
      for (const double dx : {0.0, 0.6, 1e-300, nan})
        for (const double range : {0.0, 10.0, infinity}) {
          const Vector3d origin(x, y, 0.05), direction(dx, 0.8, 0.0), up(dx, 0.0, 1.0);
          for (const Vector3d& way : {direction, up}) {
            grid.for_each_along(origin, way, range, [&](std::uint32_t) { return range; });
            corner_grid.for_each_along(origin, way, range, [&](std::uint32_t) { return range; });
          }
        }
  std::set<std::uint32_t> along;
  grid.for_each_along({-1, 0.15, 0.05}, {1, 0, 0}, 10.0, [&](std::uint32_t item) {
    along.insert(item);
    return 10.0;
  });
  EXPECT_TRUE(along.contains(near));
}

class RandomScene : public ::testing::Test {
 protected:
  RandomScene() {
    for (std::uint64_t n = 0; n < 400; ++n) {
      const bool moves = n % 2 == 0;
      const double size = n % 50 == 1 ? 2.0 : 0.05 + 0.1 * random.uniform(n, 9);
      const std::vector<Shape> shapes = {description::Box{{size, 0.1, 0.2}}, description::Sphere{0.05},
                                         description::Cylinder{0.06, 0.1}};
      scene.add({shapes[n % 50 == 1 ? 0 : n % 3], {}, BodyId{n}, moves, turned_pose(random, n, 1.5)});
    }
    scene.add({description::Plane{}, {}, BodyId{400}, false, {{0, 0, -1.4}}});
    scene.build();
    for (std::uint32_t n = 0; n < 400; n += 2) scene.set_pose(n, turned_pose(random, n + 9000, 1.5));
    scene.update();
  }

  RandomStream random{11, "geometry_test", "scene"};
  Scene scene;
};

TEST_F(RandomScene, FindsEverySolidNearbyExactlyOnce) {
  for (std::uint64_t n = 0; n < 200; ++n) {
    const Vector3d centre = random_vector(random, n + 20'000, 1.6);
    const Bounds query{centre - Vector3d::Constant(0.3), centre + Vector3d::Constant(0.3)};
    std::multiset<std::uint32_t> found;
    scene.for_each_overlap(query, [&](std::uint32_t solid) { found.insert(solid); });
    std::multiset<std::uint32_t> expected;
    for (std::uint32_t solid = 0; solid < 400; ++solid)
      if (scene.bounds(solid).overlaps(query)) expected.insert(solid);
    if (query.lower.z() <= -1.4) expected.insert(400);
    EXPECT_EQ(found, expected) << n;
  }
}

TEST_F(RandomScene, CastsRaysAsIfItTestedEverySolid) {
  int hits = 0;
  for (std::uint64_t n = 0; n < 500; ++n) {
    const Vector3d origin = random_vector(random, n + 30'000, 1.6);
    const Vector3d direction = random_vector(random, n + 40'000, 1.0).normalized();
    const double range = 0.1 + random.uniform(n, 4);
    const BodyId ignored{n % 400};
    double nearest = range;
    std::optional<std::uint32_t> expected;
    for (std::uint32_t solid = 0; solid < scene.size(); ++solid) {
      if (scene.solid(solid).body == ignored) continue;
      const Pose X_CW = scene.solid(solid).X_WC.inverse();
      const double distance =
          cast_ray(scene.solid(solid).shape(), X_CW * origin, X_CW.orientation * direction).distance;
      if (distance < nearest) {
        nearest = distance;
        expected = solid;
      }
    }
    const auto hit = scene.cast_ray(origin, direction, range, ignored);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << n;
    if (!hit) continue;
    ++hits;
    EXPECT_EQ(hit->solid, expected) << n;
    EXPECT_DOUBLE_EQ(hit->distance, nearest) << n;
    const Vector3d reach = Vector3d::Constant(range);
    // A fan whose rays do not start at its centre.
    const Vector3d centre = origin + Vector3d(0.3, -0.2, 0.1);
    const auto of_fan = RayFan(scene, centre, {origin - reach, origin + reach}, ignored).cast(origin, direction, range);
    ASSERT_TRUE(of_fan.has_value()) << n;
    EXPECT_EQ(of_fan->solid, hit->solid) << n;
    EXPECT_EQ(of_fan->distance, hit->distance) << n;
    EXPECT_EQ(of_fan->normal_W, hit->normal_W) << n;
  }
  EXPECT_GT(hits, 100);
}

TEST_F(RandomScene, CastsInfiniteRaysLikeLongOnes) {
  int hits = 0, misses = 0;
  for (std::uint64_t n = 0; n < 300; ++n) {
    const Vector3d origin = random_vector(random, n + 30'000, 3.0);
    const Vector3d direction =
        n % 3 == 0 ? Vector3d(0, 0, 1 - 2 * static_cast<double>(n % 2)) : random_vector(random, n, 1.0).normalized();
    const auto hit = scene.cast_ray(origin, direction, infinity);
    const auto expected = scene.cast_ray(origin, direction, 100.0);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << n;
    ++(hit ? hits : misses);
    if (!hit) continue;
    EXPECT_EQ(hit->solid, expected->solid) << n;
    EXPECT_EQ(hit->distance, expected->distance) << n;
  }
  EXPECT_GT(hits, 50);
  EXPECT_GT(misses, 50);
}

TEST_F(RandomScene, IsFreeIfARayHitsOnlyIgnoredBodies) {
  int free = 0;
  for (std::uint64_t n = 0; n < 1000; ++n) {
    const Vector3d origin = random_vector(random, n + 50'000, 1.6);
    const Vector3d direction = random_vector(random, n + 60'000, 1.0).normalized();
    const double range = 0.2 + 2.0 * random.uniform(n, 4);
    const auto first = scene.cast_ray(origin, direction, range);
    const BodyId one = first ? scene.solid(first->solid).body : Scene::no_body;
    EXPECT_EQ(scene.is_free(origin, direction, range, Scene::no_body), !first) << n;
    const auto second = scene.cast_ray(origin, direction, range, one);
    EXPECT_EQ(scene.is_free(origin, direction, range, one), !second) << n;
    if (!second) continue;
    // Find what is left without the first two.
    const BodyId two = scene.solid(second->solid).body;
    bool expected = true;
    for (std::uint32_t solid = 0; solid < scene.size(); ++solid) {
      const std::uint32_t those[] = {solid};
      if (scene.solid(solid).body != one && scene.solid(solid).body != two)
        expected = expected && !scene.cast_ray_among(those, origin, direction, range);
    }
    EXPECT_EQ(scene.is_free(origin, direction, range, one, two), expected) << n;
    free += expected ? 1 : 0;
  }
  EXPECT_GT(free, 30);
}

TEST(Scene, ReportsRemovedSolids) {
  Scene scene;
  const std::uint32_t ball = scene.add({description::Sphere{0.1}, {}, BodyId{0}, true, {{1, 0, 0}}});
  const std::uint32_t wall = scene.add({description::Box{{0.1, 1, 1}}, {}, BodyId{1}, false, {{2, 0, 0}}});
  scene.build();
  for (const std::uint32_t solid : {ball, wall}) {
    scene.remove(solid);
    EXPECT_TRUE(scene.is_removed(solid));
  }
  EXPECT_FALSE(scene.cast_ray({0, 0, 0}, {1, 0, 0}, infinity));
  scene.put_back(wall);
  EXPECT_TRUE(scene.is_removed(ball));
  EXPECT_FALSE(scene.is_removed(wall));
  EXPECT_DOUBLE_EQ(scene.cast_ray({0, 0, 0}, {1, 0, 0}, infinity)->distance, 1.95);
}

}  // namespace
}  // namespace cohort::geometry
