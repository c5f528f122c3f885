// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/worlds/small_world.hpp"

namespace cohort::test {
namespace {

using Eigen::Vector3d;

// Ground of every kind, all at z = 0 around the origin.
struct GroundKind {
  const char* name;
  description::Shape shape;
  double z;  // height of its origin
};

std::vector<GroundKind> grounds() {
  auto grid = std::make_shared<description::HeightGrid>();
  grid->columns = grid->rows = 21;
  grid->spacing = {0.2, 0.2};
  grid->heights.assign(grid->columns * grid->rows, 0.3);
  grid->heights[0] = 1.0;  // a peak in a corner: the middle of the heights is not the ground
  auto slab = std::make_shared<description::TriangleMesh>();
  slab->vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  slab->triangles = {{0, 1, 2}, {0, 2, 3}};
  return {{"plane", description::Plane{}, 0.0},
          {"box", description::Box{{4, 4, 1}}, -0.5},
          {"mesh", description::Mesh{slab, false}, 0.0},
          {"hull", box_mesh(Vector3d::Constant(4.0)), -2.0},
          {"heightmap", description::Heightmap{grid}, -0.3}};
}

SmallWorld on(const GroundKind& ground) {
  description::World world;
  world.name = ground.name;
  place(world, static_shape("ground", ground.shape), "ground", at(0, 0, ground.z));
  return SmallWorld(std::move(world));
}

TEST(Shapes, EveryShapeComesToRestOnEveryGround) {
  const Vector3d radii(0.1, 0.08, 0.05);
  const std::vector<std::pair<description::Shape, double>> shapes = {
      {description::Box{{0.2, 0.2, 0.1}}, 0.05}, {description::Sphere{0.1}, 0.1},
      {description::Cylinder{0.1, 0.1}, 0.05},   {description::Capsule{0.05, 0.1}, 0.1},
      {description::Ellipsoid{radii}, 0.05},     {box_mesh(Vector3d::Constant(0.2)), 0.1},
  };
  for (const GroundKind& ground : grounds()) {
    for (const auto& [shape, height] : shapes) {
      SmallWorld small = on(ground);
      const auto body = small.add(loose("body", shape, solid_box(1.0, {0.2, 0.2, 0.2})), at(0.03, 0.05, height + 0.02));
      small.run(0.5);  // a capsule that stands on its end would fall over in time
      EXPECT_NEAR(small.position(body).z(), height, 2e-3) << "shape " << shape.index() << " on " << ground.name;
      EXPECT_LT(small.velocity(body).norm(), 0.05) << "shape " << shape.index() << " on " << ground.name;
    }
  }
}

TEST(Shapes, ARobotDrivesOnEveryGround) {
  for (const GroundKind& ground : grounds()) {
    SmallWorld small = on(ground);
    const auto robot = small.add(tracked_robot(), at(-0.4, 0.03, 0));
    small.run(0.2);
    small.drive(robot, 0.1, 0.1);
    small.run(5.0);
    EXPECT_NEAR(small.position(robot).x(), 0.1, 0.01) << ground.name;
    EXPECT_NEAR(small.position(robot).z(), 0.0, 1e-3) << ground.name;
  }
}

TEST(Shapes, ABallRollsDownAHillOfAHeightMap) {
  auto grid = std::make_shared<description::HeightGrid>();
  grid->columns = grid->rows = 41;
  grid->spacing = {0.1, 0.1};
  constexpr double slope = 0.1;
  for (std::size_t row = 0; row < grid->rows; ++row)
    for (std::size_t column = 0; column < grid->columns; ++column)
      grid->heights.push_back(-slope * 0.1 * static_cast<double>(column));
  description::World world;
  world.name = "hill";
  place(world, static_shape("hill", description::Heightmap{grid}), "hill", at(2, 0, 0));
  SmallWorld small(std::move(world));
  const auto ball = small.add(loose("ball", description::Sphere{0.1}, solid_sphere(1.0, 0.1)), at(0.2, 0, 0.085));
  small.run(2.0);
  // a = 5/7 g sin(angle) along the slope. The edges between the triangles slow it down by a tenth.
  const double expected = 2.0 * 5.0 / 7.0 * g * std::sin(std::atan(slope));
  EXPECT_LT(small.velocity(ball).norm(), expected + 0.01);
  EXPECT_GT(small.velocity(ball).norm(), 0.85 * expected);
}

TEST(Shapes, RoundShapesRollWithTheirInertia) {
  struct Case {
    description::Shape shape;
    double k;  // I / m r^2
    description::Inertial inertial;
  };
  const Eigen::Quaterniond lying(Eigen::AngleAxisd(-M_PI / 2, Vector3d::UnitX()));
  for (const Case& each : {Case{description::Sphere{0.1}, 0.4, solid_sphere(1.0, 0.1)},
                           Case{description::Cylinder{0.1, 0.1}, 0.5, solid_cylinder(1.0, 0.1, 0.1, 0.0)},
                           Case{description::Capsule{0.1, 0.1}, 0.5, solid_cylinder(1.0, 0.1, 0.1, 0.0)}}) {
    constexpr double slope = 0.1;
    description::World world;
    world.name = "ramp";
    place(world, static_shape("ramp", description::Plane{}), "ramp", turned(0, 0, 0, Vector3d::UnitY(), slope));
    SmallWorld small(std::move(world));
    const Vector3d normal(std::sin(slope), 0, std::cos(slope));
    const auto body = small.add(loose("body", each.shape, each.inertial), {0.1 * normal, lying});
    small.run(2.0);
    EXPECT_NEAR(small.velocity(body).norm(), 2.0 * g * std::sin(slope) / (1.0 + each.k), 0.01)
        << "shape " << each.shape.index();
  }
}

}  // namespace
}  // namespace cohort::test
