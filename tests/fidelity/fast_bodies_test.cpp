// SPDX-License-Identifier: Apache-2.0

// A body that moves further in a step than its thickness passes through nothing.

#include <gtest/gtest.h>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::Sphere;
using Eigen::Vector3d;

class FastBodies : public EveryPhysics {
 protected:
  // Returns a world without a floor.
  description::World space(double gravity = 0.0) const {
    description::World world = GetParam().world();
    world.models.clear();
    world.instances.clear();
    world.gravity.z() = -gravity;
    world.physics.lowest = -100.0;
    return world;
  }
  static description::Model ball(double radius, const description::Surface& surface = {}) {
    return loose("ball", Sphere{radius}, solid_sphere(0.05, radius), surface);
  }
};
INSTANTIATE_TEST_SUITE_P(Every, FastBodies, ::testing::Values(treel, by_bullet(treel)), name_of);

// Returns plates of this thickness [m], in the xy plane.
std::vector<description::Shape> plates(double thickness) {
  const Vector3d size(1.0, 1.0, thickness);
  description::Mesh hull = box_mesh(size);
  description::Mesh surface = hull;
  surface.convex = false;
  return {Box{size}, hull, surface};
}

TEST_P(FastBodies, AreStoppedByAThinTable) {
  constexpr double thickness = 0.02;
  const std::vector<description::Shape> shapes{Sphere{0.005},
                                               Sphere{0.01},
                                               Box{Vector3d::Constant(0.01)},
                                               description::Cylinder{0.01, 0.02},
                                               description::Capsule{0.01, 0.02},
                                               description::Ellipsoid{Vector3d(0.01, 0.01, 0.005)},
                                               box_mesh(Vector3d::Constant(0.01))};
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    const std::vector<description::Shape> tables = plates(thickness);
    for (std::size_t table = 0; table < tables.size(); ++table) {
      SCOPED_TRACE("shape " + std::to_string(shape) + " on table " + std::to_string(table));
      SmallWorld small(space(9.81));
      small.add(static_shape("table", tables[table]), at(0, 0, -0.5 * thickness));
      const auto body =
          small.add(loose("stone", shapes[shape], solid_box(0.05, Vector3d::Constant(0.01))), at(0.013, 0.007, 2.0));
      double lowest = 2.0;
      for (int tick = 0; tick < 300; ++tick) {
        small.world().step();
        lowest = std::min(lowest, small.position(body).z());
      }
      EXPECT_GT(lowest, 0.0) << "its centre stays above";
      EXPECT_LT(small.position(body).z(), 0.012) << "and it comes to lie";
    }
  }
}

TEST_P(FastBodies, AreStoppedByAThinWall) {
  for (const double speed : {2.0, 8.0, 50.0}) {
    SCOPED_TRACE(std::to_string(speed) + " m/s");
    SmallWorld small(space());
    small.add(static_shape("wall", Box{Vector3d(0.02, 1.0, 1.0)}), at(0.51, 0, 0));
    const auto body = small.add(ball(0.01), at(0, 0, 0));
    small.world().set_root_twist(body, {Vector3d::Zero(), Vector3d(speed, 0, 0)});
    double furthest = 0.0;
    for (int tick = 0; tick < 100; ++tick) {
      small.world().step();
      furthest = std::max(furthest, small.position(body).x());
    }
    EXPECT_NEAR(furthest, 0.49, 1e-3) << "it comes to the wall and no further";
    EXPECT_LT(small.velocity(body).norm(), 1e-6 * speed) << "contacts yield by a millionth";
  }
}

TEST_P(FastBodies, BounceWithTheirRestitution) {
  SmallWorld small(space());
  const description::Surface springy{0.0, 0.8};
  small.add(static_shape("wall", Box{Vector3d(0.02, 1.0, 1.0)}, {0.0, 1.0}), at(0.51, 0, 0));
  const auto body = small.add(ball(0.01, springy), at(0, 0, 0));
  small.world().set_root_twist(body, {Vector3d::Zero(), Vector3d(8.0, 0, 0)});
  small.run(0.2);
  // The solver's compliance is 1e-5 of the 14.4 m/s.
  EXPECT_NEAR(small.velocity(body).x(), -6.4, 2e-4);
}

// Neither the corner beside its path nor the wall behind its end stops it.
TEST_P(FastBodies, AreNotStoppedByObstaclesThatTheyPass) {
  SmallWorld small(space());
  small.add(static_shape("corner", Box{Vector3d::Constant(0.2)}), at(0.5, 0.1 + 0.01 + 0.006, 0));
  const auto body = small.add(ball(0.01), at(0, 0, 0));
  small.world().set_root_twist(body, {Vector3d::Zero(), Vector3d(8.0, 0, 0)});
  small.run(0.5);
  EXPECT_NEAR(small.position(body).x(), 4.0, 1e-12);
  EXPECT_EQ(small.position(body).y(), 0.0);
  EXPECT_EQ(small.velocity(body).x(), 8.0);
}

TEST_P(FastBodies, HitEachOther) {
  for (const double offset : {0.0, 0.03, 0.05, 0.077}) {
    SCOPED_TRACE("half a step apart by " + std::to_string(offset) + " m");
    SmallWorld small(space());
    const auto one = small.add(ball(0.01, {0.0, 0.0}), at(0, 0, 0));
    const auto two = small.add(ball(0.01, {0.0, 0.0}), at(1.0 + offset, 0, 0));
    small.world().set_root_twist(one, {Vector3d::Zero(), Vector3d(8.0, 0, 0)});
    small.world().set_root_twist(two, {Vector3d::Zero(), Vector3d(-6.0, 0, 0)});
    small.run(1.0);
    EXPECT_LT(small.position(one).x(), small.position(two).x());
    EXPECT_NEAR(small.velocity(one).x(), 1.0, 3e-6) << "together";
    EXPECT_NEAR(small.velocity(two).x(), 1.0, 3e-6);
    EXPECT_NEAR(small.velocity(one).x() + small.velocity(two).x(), 2.0, 1e-9);
  }
}

TEST_P(FastBodies, PushSlowBodies) {
  for (const bool is_first : {true, false}) {  // the fast one
    SmallWorld small(space());
    const Vector3d size(0.01, 0.2, 0.2);
    const description::Model plate = loose("plate", Box{size}, solid_box(0.15, size));
    BodyId body;
    if (is_first) body = small.add(ball(0.01), at(0, 0, 0));
    const BodyId target = small.add(plate, at(0.47, 0, 0));
    if (!is_first) body = small.add(ball(0.01), at(0, 0, 0));
    small.world().set_root_twist(body, {Vector3d::Zero(), Vector3d(8.0, 0, 0)});
    small.run(0.3);
    EXPECT_LT(small.position(body).x(), small.position(target).x());
    EXPECT_NEAR(0.05 * small.velocity(body).x() + 0.15 * small.velocity(target).x(), 0.05 * 8.0, 1e-9);
    EXPECT_NEAR(small.velocity(target).x(), 2.0, 3e-6);
  }
}

// Forty balls at 8 m/s in a box of thin walls hit the walls and each other.
TEST_P(FastBodies, StayInABoxWithTheSameBitsForAnyThreadCountAndAfterRestore) {
  const auto filled = [&](unsigned threads) {
    auto small = std::make_unique<SmallWorld>(space(9.81), threads);
    for (const double side : {-1.0, 1.0})
      for (int axis = 0; axis < 3; ++axis) {
        Vector3d size = Vector3d::Constant(0.5);
        size[axis] = 0.004;
        Pose X_WM;
        X_WM.position[axis] = 0.25 * side;
        small->add(static_shape("wall_" + std::to_string(axis) + (side < 0.0 ? "a" : "b"), Box{size}, {0.5, 0.9}),
                   X_WM);
      }
    for (int i = 0; i < 40; ++i)
      small->add(ball(0.01, {0.5, 0.9}), at(0.08 * (i % 5) - 0.16, 0.08 * (i / 5 % 4) - 0.12, i < 20 ? -0.05 : 0.05));
    for (std::uint32_t body = 6; body < 46; ++body) {
      const double angle = 2.4 * body;
      small->world().set_root_twist(
          BodyId{body}, {Vector3d::Zero(), 8.0 * Vector3d(std::cos(angle), std::sin(angle), std::sin(3.0 * angle))});
    }
    return small;
  };
  const auto one = filled(1);
  const auto four = filled(4);
  const auto later = filled(2);
  one->run(0.2);
  four->run(0.2);
  ASSERT_EQ(hash_of(one->world()), hash_of(four->world()));
  restore_from(one->world(), later->world());
  for (SmallWorld* small : {one.get(), four.get(), later.get()}) small->run(1.0);
  EXPECT_EQ(hash_of(one->world()), hash_of(four->world()));
  EXPECT_EQ(hash_of(one->world()), hash_of(later->world()));
  for (std::uint32_t body = 6; body < 46; ++body) EXPECT_LT(one->position(BodyId{body}).cwiseAbs().maxCoeff(), 0.25);
}

}  // namespace
}  // namespace cohort::test
