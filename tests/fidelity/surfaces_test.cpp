// What models of the field say of their surfaces and links.

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::Sphere;
using description::Surface;
using Eigen::Vector3d;

class Surfaces : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, Surfaces,
                         ::testing::Values(articulated, by_bullet(articulated), treel, by_bullet(treel), direct),
                         name_of);

Surface with_bitmask(std::uint16_t bits) {
  Surface surface;
  surface.category_bitmask = surface.collide_bitmask = bits;
  return surface;
}

TEST_P(Surfaces, CollideOnlyWithThoseOfTheirBitmask) {
  SmallWorld small(GetParam().world());
  const auto ball = [&](double x, double z, const Surface& surface) {
    return small.add(loose("ball", Sphere{0.05}, solid_sphere(1.0, 0.05), surface), at(x, 0, z));
  };
  ball(0, 0.05, with_bitmask(1));
  const auto through = ball(0, 0.25, with_bitmask(2));
  ball(1, 0.05, with_bitmask(1));
  const auto on_top = ball(1, 0.25, with_bitmask(3));
  Surface one_sided = with_bitmask(0);
  one_sided.category_bitmask = 4;  // enough that the floor collides with it
  const auto seen_by_the_floor = ball(2, 0.1, one_sided);
  const auto by_nothing = ball(3, 0.1, with_bitmask(0));
  small.run(0.6);
  EXPECT_NEAR(small.position(through).z(), 0.05, 1e-3);
  EXPECT_NEAR(small.position(on_top).z(), 0.15, 2e-3);
  EXPECT_NEAR(small.position(seen_by_the_floor).z(), 0.05, 1e-3);
  EXPECT_LT(small.position(by_nothing).z(), -1.0);
}

// 100 m/s: a ball that is followed on its way.
TEST_P(Surfaces, WhatIsFastPassesThroughWhatItDoesNotCollideWith) {
  SmallWorld small(GetParam().world());
  small.add(static_shape("wall", Box{{0.02, 4, 4}}, with_bitmask(1)), at(1, 0, 1));
  const auto through = small.add(loose("ball", Sphere{0.02}, solid_sphere(1.0, 0.02), with_bitmask(2)), at(0, 0, 1));
  const auto stopped = small.add(loose("ball", Sphere{0.02}, solid_sphere(1.0, 0.02), with_bitmask(3)), at(0, 1, 1));
  for (const auto ball : {through, stopped})
    small.world().set_root_twist(ball, {Vector3d::Zero(), Vector3d(100, 0, 0)});
  small.run(0.1);
  EXPECT_GT(small.position(through).x(), 9.0);
  EXPECT_LT(small.position(stopped).x(), 1.0);
}

TEST(PlanarSurfaces, CollideOnlyWithThoseOfTheirBitmask) {
  SmallWorld small(planar.world());
  const Vector3d size(0.1, 0.1, 0.1);
  small.add(static_shape("wall", Box{{0.02, 4, 1}}, with_bitmask(1)), at(0.3, 0, 0.5));
  const auto through = small.add(loose("box", Box{size}, solid_box(1.0, size), with_bitmask(2)), at(0, 0, 0.05));
  const auto stopped = small.add(loose("box", Box{size}, solid_box(1.0, size), with_bitmask(3)), at(0, 1, 0.05));
  for (const auto box : {through, stopped}) small.world().set_root_twist(box, {Vector3d::Zero(), Vector3d(5, 0, 0)});
  small.run(0.3);
  EXPECT_GT(small.position(through).x(), 0.5);
  EXPECT_LT(small.position(stopped).x(), 0.3);
}

TEST(TreelSurfaces, BearTracksWhateverTheirBitmask) {
  description::World world = treel.world();
  world.models[0].links[0].collisions[0].surface = with_bitmask(0);
  SmallWorld small(std::move(world));
  const auto robot = small.add(treel.robot(), at(0, 0, 0));
  small.drive(robot, 0.1, 0.1);
  small.run(2.0);
  EXPECT_NEAR(small.position(robot).z(), 0.0, 2e-3);
  EXPECT_NEAR(small.position(robot).x(), 0.2, 0.02);
}

}  // namespace
}  // namespace cohort::test
