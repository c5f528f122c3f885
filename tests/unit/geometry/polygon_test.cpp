// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/shapes/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

#include "server/core/random.hpp"

namespace cohort::geometry {
namespace {

using description::TriangleMesh;
using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

double volume_of(const TriangleMesh& mesh) {
  double sixfold = 0.0;
  for (const auto& [a, b, c] : mesh.triangles)
    sixfold += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c]));
  return sixfold / 6.0;
}

double area_of(const Points& polygon) {
  double twofold = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& next = polygon[(i + 1) % polygon.size()];
    twofold += polygon[i].x() * next.y() - polygon[i].y() * next.x();
  }
  return 0.5 * std::abs(twofold);
}

// Each edge belongs to two triangles that traverse it in opposite directions.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, int> edges;
  for (const auto& [a, b, c] : mesh.triangles)
    for (const auto& edge : {std::array{a, b}, std::array{b, c}, std::array{c, a}}) ++edges[edge];
  return std::ranges::all_of(edges, [&](const auto& each) {
    const auto& [edge, count] = each;
    return count == 1 && edges.contains({edge[1], edge[0]});
  });
}

std::string flaw_of(const Points& polygon, const std::vector<Points>& holes = {}) {
  try {
    extruded(polygon, holes, 1.0);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ExtrudedPolygons, AreClosedMeshesOfTheirVolumeInEitherDirection) {
  Points bracket = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}};
  for (int direction = 0; direction < 2; ++direction) {
    const TriangleMesh mesh = extruded(bracket, {}, 0.5);
    EXPECT_EQ(mesh.vertices.size(), 16u);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_NEAR(volume_of(mesh), 0.5 * 7.0, 1e-12);
    std::reverse(bracket.begin(), bracket.end());
  }
}

TEST(ExtrudedPolygons, LeaveOutRepeatedPointsAndThoseOnStraightLines) {
  const TriangleMesh mesh = extruded({{0, 0}, {1, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1}, {0, 0}}, {}, 1.0);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_NEAR(volume_of(mesh), 4.0, 1e-12);
}

// Returns a polygon whose corners have random distances from its centre.
Points star_of(std::uint32_t star, const Vector2d& centre, double least, double most) {
  const RandomStream random(1, "stars", "radii");
  Points polygon;
  const std::uint32_t corners = 3 + star % 40;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    const double radius = least + (most - least) * random.uniform(star, i);
    polygon.emplace_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

TEST(ExtrudedPolygons, AreRightForStarsOfManyShapes) {
  for (std::uint32_t star = 0; star < 200; ++star) {
    const Points polygon = star_of(star, {5.0, -7.0}, 0.01, 1.01);
    const TriangleMesh mesh = extruded(polygon, {}, 2.0);
    EXPECT_TRUE(is_closed(mesh)) << star;
    EXPECT_NEAR(volume_of(mesh), 2.0 * area_of(polygon), 1e-9) << star;
  }
}

// The outline is a star, and so are up to nine holes in its middle, some of which see only other holes.
TEST(ExtrudedPolygons, AreRightForStarsWithHoles) {
  for (std::uint32_t star = 0; star < 200; ++star) {
    const Points outline = star_of(5 + star, {0.0, 0.0}, 3.0, 9.0);
    std::vector<Points> holes;
    double area = area_of(outline);
    for (std::uint32_t hole = 0; hole <= star % 9; ++hole) {
      const std::uint32_t row = hole / 3, column = hole % 3;
      holes.push_back(star_of(300 + 10 * star + hole, {column * 0.8 - 0.8, row * 0.8 - 0.8}, 0.01, 0.39));
      if (star % 2 == 0) std::ranges::reverse(holes.back());
      area -= area_of(holes.back());
    }
    const TriangleMesh mesh = extruded(outline, holes, 2.0);
    EXPECT_TRUE(is_closed(mesh)) << star;
    EXPECT_NEAR(volume_of(mesh), 2.0 * area, 1e-9) << star;
  }
}

// All corners of the holes are on lines with many others.
TEST(ExtrudedPolygons, AreRightForAGridOfHoles) {
  const auto square = [](double x, double y, double size) {
    return Points{{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
  };
  std::vector<Points> holes;
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 8; ++column) holes.push_back(square(2.0 * column + 1.0, 2.0 * row + 1.0, 1.0));
  const TriangleMesh mesh = extruded(square(0.0, 0.0, 17.0), holes, 1.0);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(volume_of(mesh), 17.0 * 17.0 - 64.0, 1e-9);
  EXPECT_NE(flaw_of(Points(500, {0, 0}), {Points(501, {0, 0})}).find("has 1001 points"), std::string::npos);
}

// A corner that protrudes by the last bit of a coordinate.
TEST(ExtrudedPolygons, DecideExactly) {
  const double x = std::nextafter(0.5, 1.0);
  EXPECT_EQ(extruded({{0, 0}, {1, 0}, {1, 1}, {0.5, 0.5}}, {}, 1.0).vertices.size(), 6u);
  EXPECT_EQ(extruded({{0, 0}, {1, 0}, {1, 1}, {x, 0.5}}, {}, 1.0).vertices.size(), 8u);
}

TEST(ExtrudedPolygons, MustBeSimple) {
  EXPECT_NE(flaw_of({}).find("has no area"), std::string::npos);
  EXPECT_NE(flaw_of({{0, 0}, {1, 1}}).find("has no area"), std::string::npos);
  EXPECT_NE(flaw_of({{0, 0}, {1, 1}, {2, 2}}).find("turns back on itself"), std::string::npos);
  EXPECT_NE(flaw_of({{0, 0}, {2, 0}, {0, 2}, {2, 2}}).find("cross or touch each other"), std::string::npos);
  EXPECT_NE(flaw_of({{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}}).find("cross or touch each other"), std::string::npos);
  EXPECT_NE(flaw_of({{0, 0}, {2, 0}, {2, 2}, {2, 1}, {3, 3}, {0, 2}}).find("turns back on itself"), std::string::npos);
  EXPECT_NE(flaw_of(Points(1001, {0, 0})).find("expected at most 1000"), std::string::npos);
}

TEST(PlacesOfPolygons, SayWhichContainsTheOther) {
  const auto square = [](double x, double half) {
    return Points{{x - half, -half}, {x + half, -half}, {x + half, half}, {x - half, half}};
  };
  EXPECT_EQ(place_of_polygon(square(0, 1), square(3, 1)), PolygonPlace::apart);
  EXPECT_EQ(place_of_polygon(square(0, 1), square(0, 2)), PolygonPlace::inside);
  EXPECT_EQ(place_of_polygon(square(0, 2), square(0, 1)), PolygonPlace::around);
  EXPECT_EQ(place_of_polygon(square(0, 1), square(1.5, 1)), PolygonPlace::crossing);
  EXPECT_EQ(place_of_polygon(square(0, 1), square(2, 1)), PolygonPlace::crossing) << "they touch";
}

}  // namespace
}  // namespace cohort::geometry
