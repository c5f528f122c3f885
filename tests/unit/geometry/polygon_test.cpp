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
  for (const auto& [edge, count] : edges)
    if (count != 1 || !edges.contains({edge[1], edge[0]})) return false;
  return true;
}

std::string flaw_of(const Points& polygon) {
  try {
    extruded(polygon, 1.0);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ExtrudedPolygons, AreClosedMeshesOfTheirVolumeInEitherDirection) {
  Points bracket = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}};
  for (int direction = 0; direction < 2; ++direction) {
    const TriangleMesh mesh = extruded(bracket, 0.5);
    EXPECT_EQ(mesh.vertices.size(), 16u);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_NEAR(volume_of(mesh), 0.5 * 7.0, 1e-12);
    std::reverse(bracket.begin(), bracket.end());
  }
}

TEST(ExtrudedPolygons, LeaveOutRepeatedPointsAndThoseOnStraightLines) {
  const TriangleMesh mesh = extruded({{0, 0}, {1, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1}, {0, 0}}, 1.0);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_NEAR(volume_of(mesh), 4.0, 1e-12);
}

// Stars, whose corners have random distances from the centre.
TEST(ExtrudedPolygons, AreRightForStarsOfManyShapes) {
  const RandomStream random(1, "stars", "radii");
  for (std::uint32_t star = 0; star < 200; ++star) {
    Points polygon;
    const std::uint32_t corners = 3 + star % 40;
    for (std::uint32_t i = 0; i < corners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / corners;
      const double radius = 0.01 + random.uniform(star, i);
      polygon.emplace_back(5.0 + radius * std::cos(angle), -7.0 + radius * std::sin(angle));
    }
    const TriangleMesh mesh = extruded(polygon, 2.0);
    EXPECT_TRUE(is_closed(mesh)) << star;
    EXPECT_NEAR(volume_of(mesh), 2.0 * area_of(polygon), 1e-9) << star;
  }
}

// A corner that protrudes by the last bit of a coordinate.
TEST(ExtrudedPolygons, DecideExactly) {
  const double x = std::nextafter(0.5, 1.0);
  EXPECT_EQ(extruded({{0, 0}, {1, 0}, {1, 1}, {0.5, 0.5}}, 1.0).vertices.size(), 6u);
  EXPECT_EQ(extruded({{0, 0}, {1, 0}, {1, 1}, {x, 0.5}}, 1.0).vertices.size(), 8u);
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
