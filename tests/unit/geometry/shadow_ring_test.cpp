// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/visibility/shadow_ring.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "server/core/infinity.hpp"
#include "tests/support/worlds/random_scene.hpp"

namespace cohort::geometry {
namespace {

using Eigen::Vector3d;

std::vector<double> shadows(const Scene& scene, const Vector3d& p_WR, double heading = 0.0, double range = 10.0,
                            BodyId ignored_body = Scene::no_body, std::size_t directions = 360) {
  const ShadowRing ring(directions);
  std::vector<double> distances(directions);
  ring.cast(scene, p_WR, heading, range, ignored_body, distances);
  return distances;
}

TEST(ShadowRing, SeesACircleBetweenItsTangents) {
  const Scene scene = scene_of(description::Cylinder{1.0, 2.0}, {{2, 0, 0}});
  const std::vector<double> distances = shadows(scene, {0, 0, 0});
  EXPECT_NEAR(distances[0], 1.0, 1e-15);
  // The tangents are at asin(1 / 2), 30 degrees; at 15, the law of cosines gives 2 cos 15 - sqrt(1 - 4 sin^2 15).
  const double angle = std::numbers::pi / 12;
  const double expected = 2 * std::cos(angle) - std::sqrt(1 - 4 * std::sin(angle) * std::sin(angle));
  EXPECT_NEAR(distances[15], expected, 1e-14);
  EXPECT_NEAR(distances[345], expected, 1e-14);
  EXPECT_TRUE(std::isfinite(distances[29]));
  EXPECT_TRUE(std::isinf(distances[31]));
  EXPECT_TRUE(std::isinf(distances[180])) << "it lies behind";
}

TEST(ShadowRing, SeesAnOrientedRectangleThroughItsFaces) {
  // A wall at x = 1 from y = -1 to y = 1, then the same rotated by 30 degrees about the ring.
  const Shape wall = description::Box{{0.2, 2.0, 1.0}};
  const std::vector<double> ahead = shadows(scene_of(wall, {{1.1, 0, 0}}), {0, 0, 0});
  for (std::size_t k = 0; k < 45; ++k)
    EXPECT_NEAR(ahead[k], 1.0 / std::cos(static_cast<double>(k) * std::numbers::pi / 180), 1e-14) << k;
  EXPECT_TRUE(std::isinf(ahead[46]));
  const double turn = std::numbers::pi / 6;
  const Pose turned = upright_pose({1.1 * std::cos(turn), 1.1 * std::sin(turn), 0}, turn);
  const std::vector<double> aside = shadows(scene_of(wall, turned), {0, 0, 0});
  for (std::size_t k = 0; k < 44; ++k) EXPECT_NEAR(aside[(k + 30) % 360], ahead[k], 1e-12) << k;
}

TEST(ShadowRing, TurnsWithItsHeading) {
  const Scene scene = scene_of(description::Sphere{0.5}, {{0, 2, 0}});
  const std::vector<double> distances = shadows(scene, {0, 0, 0}, std::numbers::pi / 2);
  EXPECT_NEAR(distances[0], 1.5, 1e-14);
  EXPECT_TRUE(std::isinf(distances[90]));
}

TEST(ShadowRing, SeesOnlySolidsThatCrossItsPlane) {
  const Scene scene = scene_of(description::Cylinder{0.5, 0.2}, {{2, 0, 0}});
  EXPECT_TRUE(std::isfinite(shadows(scene, {0, 0, 0.09})[0]));
  EXPECT_TRUE(std::isinf(shadows(scene, {0, 0, 0.11})[0]));
  EXPECT_TRUE(std::isinf(shadows(scene_of(description::Plane{}, {{0, 0, 0.5}}), {0, 0, 0})[0])) << "ground";
}

TEST(ShadowRing, SeesAnUprightPlaneAsAWall) {
  const std::vector<double> distances = shadows(scene_of(description::Plane{{-1, 0, 0}}, {{2, 0, 0}}), {0, 0, 0});
  EXPECT_NEAR(distances[60], 4.0, 1e-13);
  EXPECT_TRUE(std::isinf(distances[100]));
}

TEST(ShadowRing, FindsTheNearestSolidInRangeExceptItsOwnBody) {
  Scene scene;
  for (std::uint32_t body = 0; body < 3; ++body)
    scene.add({description::Sphere{0.25}, {}, BodyId{body}, true, {{1.0 + body, 0, 0}}});
  scene.build();
  EXPECT_DOUBLE_EQ(shadows(scene, {0, 0, 0})[0], 0.75);
  EXPECT_DOUBLE_EQ(shadows(scene, {0, 0, 0}, 0.0, 10.0, BodyId{0})[0], 1.75);
  EXPECT_TRUE(std::isinf(shadows(scene, {0, 0, 0}, 0.0, 0.74)[0]));
}

TEST(ShadowRing, HasZeroDistancesInsideASolid) {
  for (const Shape& shape : {Shape(description::Sphere{0.5}), Shape(description::Box{{1, 1, 1}})})
    for (const double distance : shadows(scene_of(shape, {{0.1, 0.1, 0}}), {0, 0, 0})) EXPECT_EQ(distance, 0.0);
}

TEST(ShadowRing, RejectsTooFewDirections) { EXPECT_THROW(ShadowRing(3), std::invalid_argument); }

// Upright cylinders and boxes of all sizes on flat ground: there, a shadow is the same as a ray.
TEST(ShadowRing, AgreesWithRaysOnFlatGround) {
  const RandomStream random(41, "shadow_ring_test", "solids");
  Scene scene;
  for (std::uint32_t n = 0; n < 300; ++n) {
    const double width = 0.05 + 0.3 * random.uniform(n, 5);
    const Pose X_WC =
        upright_pose({6 * random.uniform(n, 0), 6 * random.uniform(n, 1), 0.1}, 6.3 * random.uniform(n, 2));
    const Shape shape =
        n % 2 == 0 ? Shape(description::Cylinder{0.5 * width, 0.2}) : Shape(description::Box{{width, 0.1, 0.2}});
    scene.add({shape, {}, BodyId{n}, n % 4 < 2, X_WC});
  }
  scene.add({description::Plane{}, {}, BodyId{300}, false, {}});
  scene.build();
  const ShadowRing ring(360);
  std::vector<double> distances(ring.size());
  int hits = 0, misses = 0, grazed = 0;
  for (std::uint64_t n = 0; n < 100; ++n) {
    const auto own = static_cast<std::uint32_t>(n);
    const Vector3d p_WR = scene.solid(own).X_WC.position;
    const double heading = 6.3 * random.uniform(n, 3);
    const double range = 0.1 + 2.0 * random.uniform(n, 4);
    ring.cast(scene, p_WR, heading, range, BodyId{own}, distances);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vector3d direction =
          Eigen::AngleAxisd(heading, Vector3d::UnitZ()) * Vector3d(ring.direction(k).x(), ring.direction(k).y(), 0.0);
      const auto hit = scene.cast_ray(p_WR, direction, range, BodyId{own});
      if (hit.has_value() != std::isfinite(distances[k])) {
        ++grazed;  // by less than rounding
      } else if (hit) {
        // At a tangent, the root turns a rounding error of 1e-16 into 1e-8.
        EXPECT_NEAR(distances[k], hit->distance, 1e-7) << n << " " << k;
        ++hits;
      } else {
        ++misses;
      }
    }
  }
  EXPECT_GT(hits, 10000);
  EXPECT_GT(misses, 1000);
  EXPECT_EQ(grazed, 0);
}

}  // namespace
}  // namespace cohort::geometry
