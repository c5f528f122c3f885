// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "server/core/random.hpp"
#include "server/geometry/scene/scene.hpp"
#include "server/geometry/shapes/convex_hull.hpp"

/// Scenes of one solid, and random scenes with solids of all shapes.
namespace cohort::geometry {

/// Returns a built scene with one solid.
inline Scene scene_of(const Shape& shape, const Pose& X_WC) {
  Scene scene;
  scene.add({shape, {}, BodyId{0}, !is_ground(shape), X_WC});
  scene.build();
  return scene;
}

inline Eigen::Vector3d random_vector(const RandomStream& random, std::uint64_t n, double half_width) {
  return {half_width * (2 * random.uniform(n, 0) - 1), half_width * (2 * random.uniform(n, 1) - 1),
          half_width * (2 * random.uniform(n, 2) - 1)};
}

inline Pose upright_pose(const Eigen::Vector3d& position, double yaw) {
  return {position, Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))};
}

/// Returns a random pose. By `n`, one third are upright, one third lean slightly, and the others have any orientation.
inline Pose random_pose(const RandomStream& random, std::uint64_t n, double half_width, double half_height) {
  Eigen::Vector3d position = random_vector(random, n, half_width);
  position.z() *= half_height / half_width;
  Pose pose = upright_pose(position, 6.3 * random.uniform(n, 3));
  if (n % 3 == 0) return pose;
  const double lean = n % 3 == 1 ? 0.1 * random.uniform(n, 4) : 6.3 * random.uniform(n, 4);
  const Eigen::Vector3d axis = random_vector(random, n + 1'000'000, 1.0).normalized();
  pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(lean, axis)) * pose.orientation;
  return pose;
}

inline description::Mesh random_mesh(const RandomStream& random, std::uint64_t n, bool convex) {
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < 12; ++i) points.push_back(random_vector(random, 2'000'000 + 100 * n + i, 0.1));
  auto triangles = std::make_shared<description::TriangleMesh>(geometry::convex_hull(points));
  if (n % 2 == 0 && !convex) triangles->triangles.pop_back();  // an open surface
  return {triangles, convex};
}

inline std::shared_ptr<const description::HeightGrid> random_heights(const RandomStream& random, std::size_t edge,
                                                                     double spacing, double highest) {
  auto grid = std::make_shared<description::HeightGrid>();
  grid->columns = grid->rows = edge;
  grid->spacing = Eigen::Vector2d::Constant(spacing);
  for (std::size_t i = 0; i < edge * edge; ++i) grid->heights.push_back(highest * random.uniform(3'000'000 + i, 0));
  return grid;
}

/// Returns a built scene with `count` solids in a box of `half_width` along x and y and `half_height` along z. Each has
/// its own body, except every fifth, which belongs to the body of the previous one. Half of them move. Below them are
/// planes and height maps as ground, beside them an inclined plane, and among them walls.
inline Scene random_scene(std::uint64_t seed, std::uint32_t count, double half_width, double half_height) {
  const RandomStream random(seed, "random_scene", "solids");
  Scene scene;
  std::uint32_t body = 0;
  for (std::uint32_t n = 0; n < count; ++n) {
    const double size = 0.02 + 0.1 * random.uniform(n, 9);
    const std::vector<Shape> shapes = {description::Box{{size, 0.1, 0.2}},
                                       description::Sphere{0.5 * size},
                                       description::Cylinder{0.06, size},
                                       description::Capsule{0.04, size},
                                       description::Ellipsoid{{size, 0.05, 0.08}},
                                       random_mesh(random, n, true),
                                       random_mesh(random, n, false)};
    if (n % 5 != 4) ++body;
    scene.add(
        {shapes[n % shapes.size()], {}, BodyId{body}, n % 2 == 0, random_pose(random, n, half_width, half_height)});
  }
  const auto add_static = [&](Shape shape, const Pose& X_WC) {
    scene.add({std::move(shape), {}, BodyId{++body}, false, X_WC});
  };
  for (std::uint64_t n = 0; n < 4; ++n)
    add_static(description::Box{{half_width, 0.02, 0.3}}, random_pose(random, 5000 + 3 * n, half_width, half_height));
  add_static(description::Plane{{0.6, 0.0, 0.8}}, {{-1.2 * half_width, 0, 0}});
  add_static(description::Plane{}, {{0, 0, -0.9 * half_height}});
  add_static(description::Heightmap{random_heights(random, 9, 0.2 * half_width, 0.5 * half_height)},
             upright_pose({0.2 * half_width, 0, -half_height}, 0.3));
  add_static(description::Heightmap{random_heights(random, 5, 0.1 * half_width, 0.1)},
             {{0.8 * half_width, 0.8 * half_width, -half_height},
              Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()))});
  scene.build();
  return scene;
}

}  // namespace cohort::geometry
