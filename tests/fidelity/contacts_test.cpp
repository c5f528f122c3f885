#include <gtest/gtest.h>

#include "tests/support/worlds/small_world.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::Sphere;
using Eigen::Vector3d;

SmallWorld on_slope(double slope, double friction) {
  description::World world;
  world.name = "slope";
  place(world, static_shape("plane", description::Plane{}, {friction, 0.0}), "plane",
        turned(0, 0, 0, Vector3d::UnitY(), slope));
  return SmallWorld(std::move(world));
}

TEST(Contacts, ABoxOnASlopeSlidesAgainstFriction) {
  constexpr double slope = 0.4;
  SmallWorld small = on_slope(slope, 0.2);
  const Vector3d size(0.2, 0.2, 0.1);
  const Vector3d normal(std::sin(slope), 0, std::cos(slope));
  const auto box = small.add(loose("box", Box{size}, solid_box(1.0, size)),
                             {0.05 * normal, Eigen::Quaterniond(Eigen::AngleAxisd(slope, Vector3d::UnitY()))});
  small.run(0.5);
  const double early = small.velocity(box).norm();
  small.run(1.0);
  EXPECT_NEAR(small.velocity(box).norm() - early, g * (std::sin(slope) - 0.2 * std::cos(slope)), 0.01);
}

TEST(Contacts, ABoxOnASlopeWithinItsFrictionStays) {
  constexpr double slope = 0.4;
  SmallWorld small = on_slope(slope, 0.6);
  const Vector3d size(0.2, 0.2, 0.1);
  const Vector3d normal(std::sin(slope), 0, std::cos(slope));
  const auto box = small.add(loose("box", Box{size}, solid_box(1.0, size)),
                             {0.05 * normal, Eigen::Quaterniond(Eigen::AngleAxisd(slope, Vector3d::UnitY()))});
  small.run(0.5);
  const Vector3d settled = small.position(box);
  small.run(5.0);
  EXPECT_LT((small.position(box) - settled).norm(), 0.4e-3);
}

TEST(Contacts, FrictionIsTheSameInEveryDirection) {
  for (const double heading : {0.0, 0.3, M_PI / 4, 1.2}) {
    SmallWorld small(world_with_floor(0.3));
    const Vector3d size(0.2, 0.2, 0.05);
    const auto box = small.add(loose("box", Box{size}, solid_box(1.0, size)), at(0, 0, 0.025));
    small.run(0.2);
    small.world().set_root_twist(box, {Vector3d::Zero(), Vector3d(std::cos(heading), std::sin(heading), 0)});
    small.run(1.0);
    // It slides v^2 / (2 mu g), straight on.
    const Vector3d way = small.position(box);
    EXPECT_NEAR(way.head<2>().norm(), 1.0 / (2.0 * 0.3 * g), 0.01);
    EXPECT_NEAR(std::atan2(way.y(), way.x()), heading, 0.01);
  }
}

TEST(Contacts, ABallBouncesToTheSquareOfItsRestitution) {
  description::World world = world_with_floor();
  world.step = std::chrono::milliseconds(1);
  world.models.edit(0).links[0].collisions[0].surface.restitution = 1.0;
  SmallWorld small(std::move(world));
  const auto ball = small.add(loose("ball", Sphere{0.05}, solid_sphere(1.0, 0.05), {1.0, 0.8}), at(0, 0, 1.05));
  double highest = 0.0;
  bool bounced = false;
  for (int i = 0; i < 1200; ++i) {
    small.world().step();
    bounced = bounced || small.velocity(ball).z() > 0.0;
    if (bounced) highest = std::max(highest, small.position(ball).z() - 0.05);
  }
  EXPECT_NEAR(highest, 0.64, 0.02);
}

TEST(Contacts, ABallThatDoesNotBounceComesToRestAndStays) {
  SmallWorld small;
  const auto ball = small.add(loose("ball", Sphere{0.05}, solid_sphere(1.0, 0.05), {1.0, 0.5}), at(0, 0, 0.3));
  small.run(5.0);
  EXPECT_NEAR(small.position(ball).z(), 0.05, 1e-3);
  EXPECT_LT(small.velocity(ball).norm(), 1e-3);
}

TEST(Contacts, RollingResistanceStopsARollingBall) {
  SmallWorld small;
  description::Surface surface;
  surface.rolling_resistance = 0.005;
  const auto ball = small.add(loose("ball", Sphere{0.1}, solid_sphere(1.0, 0.1), surface), at(0, 0, 0.1));
  small.run(0.1);
  small.world().set_root_twist(ball, {Vector3d(0, 5.0, 0), Vector3d(0.5, 0, 0)});
  small.run(10.0);
  // The torque c m g removes the energy 7/10 m v^2 over the angle x / r.
  EXPECT_NEAR(small.position(ball).x(), 0.7 * 0.25 / (g * 0.005 / 0.1), 0.02);
  EXPECT_LT(small.velocity(ball).norm(), 1e-3);
}

TEST(Contacts, APairOfMaterialsHasItsOwnFriction) {
  SmallWorld small;
  small.description.materials = {"", "ice", "felt"};
  small.description.material_pairs = {{1, 2, 0.05, 0.0, 0.0}};
  small.description.models.edit(0).links[0].collisions[0].surface.material = 1;
  const Vector3d size(0.2, 0.2, 0.05);
  description::Surface felt;
  felt.material = 2;
  const auto slides = small.add(loose("felt", Box{size}, solid_box(1.0, size), felt), at(0, 0, 0.025));
  const auto stops = small.add(loose("other", Box{size}, solid_box(1.0, size)), at(0, 1, 0.025));
  small.run(0.2);
  for (const auto body : {slides, stops}) small.world().set_root_twist(body, {Vector3d::Zero(), Vector3d(0.5, 0, 0)});
  small.run(2.0);
  EXPECT_NEAR(small.position(slides).x(), 0.25 / (2.0 * 0.05 * g), 0.01);
  EXPECT_NEAR(small.position(stops).x(), 0.25 / (2.0 * 1.0 * g), 0.01);
}

TEST(Contacts, AStackOfBoxesStands) {
  SmallWorld small;
  const Vector3d size(0.2, 0.2, 0.2);
  std::vector<BodyId> boxes;
  boxes.reserve(6);
  for (int i = 0; i < 6; ++i)
    boxes.push_back(small.add(loose("box", Box{size}, solid_box(1.0, size)), at(0, 0, 0.1 + 0.2 * i)));
  small.run(10.0);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_NEAR(small.position(boxes[i]).z(), 0.1 + 0.2 * static_cast<double>(i), 5e-3);
    EXPECT_LT(small.position(boxes[i]).head<2>().norm(), 5e-3);
  }
}

TEST(Contacts, ReportBodiesPointsAndForces) {
  SmallWorld small;
  const Vector3d size(0.2, 0.2, 0.1);
  const auto box = small.add(loose("box", Box{size}, solid_box(3.0, size)), at(0, 0, 0.05));
  small.run(1.0);
  double force = 0.0;
  for (const physics::Contact& contact : small.world().contacts()) {
    EXPECT_EQ(contact.body_a, box);
    EXPECT_EQ(contact.body_b, BodyId{0});
    EXPECT_TRUE(contact.normal_W.isApprox(Vector3d::UnitZ(), 1e-9));
    EXPECT_NEAR(contact.position_W.z(), 0.0, 1e-3);
    force += contact.impulse / 0.01;
  }
  EXPECT_NEAR(force, 3.0 * g, 1e-3);
}

TEST(Contacts, ACollisionConservesMomentum) {
  SmallWorld small(world_with_floor());
  small.description.gravity = Vector3d::Zero();
  const auto one = small.add(loose("one", Sphere{0.05}, solid_sphere(1.0, 0.05), {0.5, 0.9}), at(-0.5, 0, 1));
  const auto two = small.add(loose("two", Sphere{0.05}, solid_sphere(3.0, 0.05), {0.5, 0.9}), at(0, 0.03, 1));
  small.world().set_root_twist(one, {Vector3d(0, 0, 3), Vector3d(1, 0, 0)});
  small.run(2.0);
  const Vector3d momentum = 1.0 * small.velocity(one) + 3.0 * small.velocity(two);
  EXPECT_TRUE(momentum.isApprox(Vector3d(1, 0, 0), 1e-9)) << momentum.transpose();
  EXPECT_GT(small.velocity(two).x(), 0.3);
}

}  // namespace
}  // namespace cohort::test
