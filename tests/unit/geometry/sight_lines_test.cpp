// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/visibility/sight_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "server/core/infinity.hpp"
#include "tests/support/worlds/random_scene.hpp"

namespace cohort::geometry {
namespace {

using Eigen::Vector3d;

bool sees(const Scene& scene, const Vector3d& source, const Vector3d& receiver, double range = infinity,
          BodyId source_body = Scene::no_body, BodyId receiver_body = Scene::no_body) {
  const Outlines outlines(scene);
  SightLines lines;
  lines.build(outlines, source, range, source_body);
  return lines.is_free(receiver, receiver_body);
}

TEST(SightLines, AreBlockedByACylinderAndPassBesideIt) {
  const Scene scene = scene_of(description::Cylinder{0.06, 0.1}, upright_pose({2, 0, 0}, 0));
  EXPECT_FALSE(sees(scene, {0, 0, 0}, {4, 0, 0}));
  EXPECT_TRUE(sees(scene, {0, 0, 0}, {1.939, 0, 0})) << "the receiver stands before it";
  EXPECT_FALSE(sees(scene, {0, 0, 0}, {1.941, 0, 0})) << "the receiver is inside";
  // The tangent of a circle of radius r at distance d has the slope r / sqrt(d^2 - r^2).
  const double tangent = 0.06 / std::sqrt(4.0 - 0.0036);
  for (const double side : {-4.0, 4.0}) {
    EXPECT_FALSE(sees(scene, {0, 0, 0}, {4, side * (tangent - 1e-10), 0}));
    EXPECT_TRUE(sees(scene, {0, 0, 0}, {4, side * (tangent + 1e-10), 0}));
  }
}

TEST(SightLines, FromAboveAreBlockedOnlyInTheShadow) {
  // A lamp is 1 m above the floor; a wall of 0.2 m has its top edge 2 m away. The shadow ends where the line over the
  // top reaches the floor, at 2 * 1 / 0.8 = 2.5 m.
  const Scene scene = scene_of(description::Box{{0.02, 4.0, 0.2}}, {{1.99, 0, 0.1}});
  EXPECT_FALSE(sees(scene, {0, 0, 1}, {2.5 - 1e-9, 0, 0}));
  EXPECT_TRUE(sees(scene, {0, 0, 1}, {2.5 + 1e-9, 0, 0}));
  EXPECT_FALSE(sees(scene, {0, 0, 1}, {2.2, 0.3, 0}));
}

TEST(SightLines, UprightHitSolidsAboveAndBelow) {
  const Scene scene = scene_of(description::Cylinder{0.5, 0.1}, upright_pose({0, 0, 1}, 0));
  EXPECT_FALSE(sees(scene, {0.1, 0.2, 3}, {0.1, 0.2, 0}));
  EXPECT_TRUE(sees(scene, {0.1, 0.2, 3}, {0.1, 0.2, 1.06}));
  EXPECT_TRUE(sees(scene, {0.6, 0.2, 3}, {0.6, 0.2, 0}));
  EXPECT_FALSE(sees(scene, {0.1, 0.2, 3}, {0.1 + 1e-15, 0.2, 0}));
  EXPECT_FALSE(sees(scene, {0.1, 0.0, 3}, {0.1, 1e-170, 0})) << "squares of such lengths are 0";
}

TEST(SightLines, AreNotBlockedByTheBodiesAtTheirEnds) {
  Scene scene;
  for (std::uint32_t body = 0; body < 3; ++body)
    scene.add({description::Sphere{0.1}, {}, BodyId{body}, true, upright_pose({1.0 * body, 0, 0}, 0)});
  scene.build();
  EXPECT_TRUE(sees(scene, {0, 0, 0}, {1, 0, 0}, infinity, BodyId{0}, BodyId{1}));
  EXPECT_FALSE(sees(scene, {0, 0, 0}, {1, 0, 0}, infinity, BodyId{0})) << "whose receiver is not named";
  EXPECT_FALSE(sees(scene, {0, 0, 0}, {2, 0, 0}, infinity, BodyId{0}, BodyId{2}));
}

TEST(SightLines, EndAtTheRange) {
  const Scene scene = scene_of(description::Sphere{0.1}, {{0, 5, 0}});
  EXPECT_TRUE(sees(scene, {0, 0, 0}, {3, 0, 4}, 5.0));
  EXPECT_FALSE(sees(scene, {0, 0, 0}, {3, 0, 4}, 4.999));
  EXPECT_TRUE(sees(scene, {0, 0, 0}, {0, 0, 0}, 0.0)) << "both ends are the same";
}

TEST(SightLines, AreFreeWhereASolidWasRemoved) {
  Scene scene = scene_of(description::Sphere{0.1}, {{1, 0, 0}});
  scene.remove(0);
  EXPECT_TRUE(sees(scene, {0, 0, 0}, {2, 0, 0}));
  scene.put_back(0);
  EXPECT_FALSE(sees(scene, {0, 0, 0}, {2, 0, 0}));
}

struct Count {
  int free = 0;
  int blocked = 0;
};

// Compares sight lines with rays against every solid.
Count compare(const Scene& scene, std::uint64_t seed, double half_width, double half_height, double range, int sources,
              int receivers) {
  const RandomStream random(seed, "sight_lines_test", "ends");
  const Outlines outlines(scene);
  SightLines lines, within_heights;
  Count count;
  for (int i = 0; i < sources; ++i) {
    const auto n = static_cast<std::uint64_t>(i);
    Vector3d source = random_vector(random, n, half_width);
    source.z() *= half_height / half_width;
    BodyId source_body = Scene::no_body;
    if (i % 2 != 0) {
      const geometry::Solid& of_source = scene.solid(static_cast<std::uint32_t>(i % 100));
      source = of_source.X_WC.position;
      source_body = of_source.body;
    }
    lines.build(outlines, source, range, source_body);
    for (int j = 0; j < receivers; ++j) {
      const std::uint64_t m = 100'000 + n * 1000 + static_cast<std::uint64_t>(j);
      const auto of_receiver = static_cast<std::uint32_t>(m % 100);
      const BodyId receiver_body = scene.solid(of_receiver).body;
      Vector3d receiver = scene.solid(of_receiver).X_WC.position;
      if (j % 3 == 0) receiver = random_vector(random, m, half_width);
      if (j % 3 == 1) receiver += random_vector(random, m, 0.2);
      if (range < infinity && j % 3 != 2) receiver = source + random_vector(random, m, 0.6 * range);
      if (j % 20 == 0) receiver.head<2>() = source.head<2>();
      const Vector3d offset = receiver - source;
      const double distance = offset.norm();
      if (distance == 0.0 || distance > range) {
        EXPECT_EQ(lines.is_free(receiver, receiver_body), distance == 0.0);
        continue;
      }
      std::vector<std::uint32_t> others;
      for (std::uint32_t solid = 0; solid < scene.size(); ++solid)
        if (scene.solid(solid).body != source_body && scene.solid(solid).body != receiver_body) others.push_back(solid);
      const bool expected = !scene.cast_ray_among(others, source, offset / distance, distance);
      EXPECT_EQ(lines.is_free(receiver, receiver_body), expected) << i << " " << j;
      if (j % 5 == 0) {
        // Built for receivers within heights that include this one.
        within_heights.build(outlines, source, range, source_body, {receiver.z() - 0.01 * (j % 3), receiver.z()});
        EXPECT_EQ(within_heights.is_free(receiver, receiver_body), expected) << i << " " << j;
      }
      if (source_body == Scene::no_body) {
        EXPECT_EQ(!scene.cast_ray(source, offset / distance, distance, receiver_body), expected) << i << " " << j;
      }
      ++(expected ? count.free : count.blocked);
    }
  }
  return count;
}

TEST(SightLines, AgreeWithRaysAgainstEverySolid) {
  for (const double half_height : {0.1, 1.0}) {
    const Scene scene = random_scene(31, 150, 1.5, half_height);
    const Count count = compare(scene, 32, 1.5, half_height, infinity, 50, 200);
    EXPECT_GT(count.free, 400);
    EXPECT_GT(count.blocked, 400);
  }
}

TEST(SightLines, OfShortRangeAgreeWithRaysAgainstEverySolid) {
  const Scene scene = random_scene(33, 3000, 3.0, 0.2);
  const Count count = compare(scene, 34, 3.0, 0.2, 0.5, 400, 20);
  EXPECT_GT(count.free, 400);
  EXPECT_GT(count.blocked, 400);
}

}  // namespace
}  // namespace cohort::geometry
