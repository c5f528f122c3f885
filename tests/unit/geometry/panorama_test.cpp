// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/visibility/panorama.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "server/core/infinity.hpp"
#include "tests/support/worlds/random_scene.hpp"

namespace cohort::geometry {
namespace {

using Eigen::Vector3d;
using Image = std::vector<std::optional<RayHit>>;
using std::numbers::pi;

std::vector<double> even_elevations(std::size_t rows, double least, double most) {
  std::vector<double> elevations;
  for (std::size_t row = 0; row < rows; ++row)
    elevations.push_back(least + (most - least) * static_cast<double>(row) / static_cast<double>(rows - 1));
  return elevations;
}

Image image_of(const Panorama& panorama, const Scene& scene, const Pose& X_WS, double range = infinity,
               BodyId ignored_body = Scene::no_body) {
  Image image(panorama.columns() * panorama.rows());
  panorama.cast(Outlines(scene), X_WS, range, ignored_body, image);
  return image;
}

TEST(Panorama, SeesASphereInTheDirectionsWithinItsAngularRadius) {
  const Scene scene = scene_of(description::Sphere{0.5}, {{0, 2, 0}});
  const Panorama panorama(90, even_elevations(41, -0.8, 0.8));
  const Image image = image_of(panorama, scene, {});
  const double radius = std::asin(0.25);
  int seen = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const double angle = std::acos(panorama.direction(i).y());
    ASSERT_EQ(image[i].has_value(), angle < radius) << i;
    if (!image[i]) continue;
    ++seen;
    EXPECT_NEAR(image[i]->distance, 2 * std::cos(angle) - std::sqrt(0.25 - 4 * std::sin(angle) * std::sin(angle)),
                1e-12);
  }
  EXPECT_GT(seen, 50);
}

TEST(Panorama, SeesTheFloorBelowTheHorizonAtTheHeightOverTheSine) {
  const Scene scene = scene_of(description::Plane{}, {});
  const Panorama panorama(8, even_elevations(11, -0.5, 0.5));
  const Image image = image_of(panorama, scene, {{3, 4, 0.2}});
  for (std::size_t row = 0; row < 11; ++row) {
    const auto& pixel = image[panorama.pixel(5, row)];
    ASSERT_EQ(pixel.has_value(), row < 5) << row;
    if (!pixel) continue;
    EXPECT_NEAR(pixel->distance, 0.2 / std::sin(0.5 - 0.1 * static_cast<double>(row)), 1e-12);
    EXPECT_EQ(pixel->normal_W, Vector3d(0, 0, 1));
  }
}

TEST(Panorama, TurnsWithItsFrame) {
  const Scene scene = scene_of(description::Sphere{0.1}, {{0, 0, 2}});
  // Its x axis points upwards.
  const Pose X_WS{Vector3d::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(-pi / 2, Vector3d::UnitY()))};
  const Panorama panorama(4, {0.0});
  const Image image = image_of(panorama, scene, X_WS);
  ASSERT_TRUE(image[0].has_value());
  EXPECT_NEAR(image[0]->distance, 1.9, 1e-12);
  EXPECT_FALSE(image[1].has_value());
}

TEST(Panorama, RejectsInvalidColumnsAndElevations) {
  EXPECT_THROW(Panorama(3, {0.0}), std::invalid_argument);
  EXPECT_THROW(Panorama(8, {}), std::invalid_argument);
  EXPECT_THROW(Panorama(8, {0.0, 0.2, 0.1}), std::invalid_argument);
  EXPECT_THROW(Panorama(8, {0.0, 1.6}), std::invalid_argument);
}

// Compares all pixels of an image with Scene::cast_ray, bit for bit. Returns how many have a hit.
int compare(const Panorama& panorama, const Scene& scene, const Pose& X_WS, double range, BodyId ignored_body) {
  const Image image = image_of(panorama, scene, X_WS, range, ignored_body);
  int seen = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const auto hit = scene.cast_ray(X_WS.position, X_WS.orientation * panorama.direction(i), range, ignored_body);
    EXPECT_EQ(image[i].has_value(), hit.has_value()) << i;
    if (!hit || !image[i]) continue;
    ++seen;
    EXPECT_EQ(image[i]->solid, hit->solid) << i;
    EXPECT_EQ(image[i]->distance, hit->distance) << i;
    EXPECT_EQ(image[i]->normal_W, hit->normal_W) << i;
  }
  return seen;
}

TEST(Panorama, AgreesWithRays) {
  const RandomStream random(51, "panorama_test", "views");
  const Panorama level(90, even_elevations(17, -0.4, 0.4));
  const Panorama whole(60, even_elevations(25, 0.5 * pi, -0.5 * pi));
  for (const double half_height : {0.1, 1.0}) {
    Scene scene = random_scene(52, 150, 1.5, half_height);
    scene.remove(7);
    int seen = 0;
    for (std::uint64_t n = 0; n < 30; ++n) {
      const double range = n % 2 == 0 ? 20.0 : 0.3 + random.uniform(n, 8);  // without a range, cast_ray would not end
      const BodyId ignored = n % 4 == 0 ? Scene::no_body : scene.solid(static_cast<std::uint32_t>(n)).body;
      Pose X_WS = random_pose(random, n, 1.2, half_height);
      if (n % 4 == 3) X_WS.position = scene.solid(static_cast<std::uint32_t>(n)).X_WC.position;
      seen += compare(n % 2 == 0 ? level : whole, scene, X_WS, range, ignored);
    }
    EXPECT_GT(seen, 10000);
  }
}

}  // namespace
}  // namespace cohort::geometry
