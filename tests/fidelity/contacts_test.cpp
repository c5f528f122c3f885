// SPDX-License-Identifier: Apache-2.0
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

// The peaks are those of the restitution, also if the ball touches the ground at any time within a step.
TEST(Contacts, ABallBouncesToTheSquareOfItsRestitution) {
  for (const int step : {10, 5, 2, 1})
    for (const double restitution : {1.0, 0.9, 0.8, 0.5})
      for (const double height : {0.31, 1.0, 1.37}) {
        SCOPED_TRACE("e " + std::to_string(restitution) + ", " + std::to_string(height) + " m, " +
                     std::to_string(step) + " ms");
        description::World world = world_with_floor();
        world.step = std::chrono::milliseconds(step);
        world.models.edit(0).links[0].collisions[0].surface.restitution = 1.0;
        SmallWorld small(std::move(world));
        const auto ball = small.add(loose("ball", Sphere{0.05}, solid_sphere(1.0, 0.05), {1.0, restitution}),
                                    at(0, 0, 0.05 + height));
        const double seconds = 1e-3 * step;
        double expected = height;
        for (int bounce = 0; bounce < 3; ++bounce) {
          const auto goes_on = [&](bool up) { return (small.velocity(ball).z() > 0.0) == up; };
          for (int k = 0; k < 2000 / step && goes_on(false); ++k) small.world().step();
          double peak = 0.0;
          for (int k = 0; k < 2000 / step && goes_on(true); ++k) {
            peak = std::max(peak, small.position(ball).z() - 0.05);
            small.world().step();
          }
          expected *= restitution * restitution;
          const double between = 0.125 * g * seconds * seconds;  // the peak is between two steps, as is the start
          EXPECT_LT(peak, expected + between);
          EXPECT_GT(peak, expected - between);
        }
      }
}

// It neither sinks nor rises in a minute.
TEST(Contacts, ABallThatLosesNothingBouncesForEver) {
  for (const int step : {10, 1}) {
    description::World world = world_with_floor();
    world.step = std::chrono::milliseconds(step);
    world.models.edit(0).links[0].collisions[0].surface.restitution = 1.0;
    SmallWorld small(std::move(world));
    const auto ball = small.add(loose("ball", Sphere{0.05}, solid_sphere(1.0, 0.05), {1.0, 1.0}), at(0, 0, 10.05));
    small.run(56.0);
    double peak = 0.0;
    for (int i = 0; i < 4000 / step; ++i) {
      small.world().step();
      peak = std::max(peak, small.position(ball).z() - 0.05);
    }
    EXPECT_NEAR(peak, 10.0, 0.01) << step << " ms";
  }
}

// Corners, edges and rims hit the ground at any time within a step, also while other points slide on it. Without any
// loss, a tumbling body gains a few per cent in steps of 5 ms, and up to 240 % in steps of 10. Friction at an impact
// without loss may add energy in any step.
TEST(Contacts, NothingGainsEnergyByBouncing) {
  const Vector3d size(0.2, 0.12, 0.08);
  for (const double restitution : {1.0, 0.9, 0.6})
    for (const double friction : {0.0, 0.5})
      for (const int step : {10, 2})
        for (int i = 0; i < 6 && (restitution < 1.0 || (friction == 0.0 && step == 2)); ++i) {
          description::World world = world_with_floor(friction);
          world.step = std::chrono::milliseconds(step);
          world.models.edit(0).links[0].collisions[0].surface.restitution = 1.0;
          SmallWorld small(std::move(world));
          const description::Surface surface{friction, restitution};
          const bool is_box = i % 2 == 0;
          const description::Shape shape =
              is_box ? description::Shape(Box{size}) : description::Shape(description::Cylinder{0.06, 0.16});
          const auto body = small.add(loose("body", shape, solid_box(1.0, size), surface),
                                      turned(0, 0, 0.8, Vector3d(1, 0.3 * i, 0.1).normalized(), 0.4 * i));
          small.world().set_root_twist(body, {Vector3d(i, 2, -1), Vector3d(0.5, 0, 0)});
          const auto energy = [&] {
            const physics::Twist twist = small.world().link_twist(body, LinkId{0});
            const Pose pose = small.world().link_pose(body, LinkId{0});
            const Vector3d spin = pose.orientation.conjugate() * twist.angular_W;
            return 0.5 * twist.linear_W.squaredNorm() +
                   0.5 * spin.dot(Eigen::Matrix3d(solid_box(1.0, size).inertia) * spin) + g * pose.position.z();
          };
          const double before = energy();
          double highest = before;
          for (int k = 0; k < 10'000 / step; ++k) {
            small.world().step();
            highest = std::max(highest, energy());
          }
          EXPECT_LT(highest, 1.02 * before + g * 1e-3 * step)
              << restitution << " " << friction << " " << step << " " << i;
        }
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
