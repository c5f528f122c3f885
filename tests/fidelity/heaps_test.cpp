// SPDX-License-Identifier: Apache-2.0

// Bodies that stand on or lie between each other come to rest, and then sleep: at default settings.

#include <gtest/gtest.h>

#include <algorithm>

#include "server/core/random.hpp"
#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using Eigen::Vector3d;

class Heaps : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, Heaps, ::testing::Values(treel, by_bullet(treel)), name_of);

struct Heap {
  explicit Heap(description::World world, unsigned threads = 1) : small(std::move(world), threads) {}

  SmallWorld small;
  std::vector<BodyId> bodies;
  std::vector<Vector3d> places;

  void add(const description::Shape& shape, const description::Inertial& inertial, const Pose& X_WM,
           double friction = 0.5) {
    bodies.push_back(small.add(loose("body", shape, inertial, {friction, 0.0}), X_WM));
    places.push_back(X_WM.position);
  }
  void add_box(const Vector3d& size, double mass, const Vector3d& place, double friction = 0.5) {
    add(Box{size}, solid_box(mass, size), at(place.x(), place.y(), place.z()), friction);
  }
  double furthest() {
    double furthest = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      furthest = std::max(furthest, (small.position(bodies[i]) - places[i]).norm());
    return furthest;
  }
  double greatest_speed() {
    double greatest = 0.0;
    for (const BodyId body : bodies) greatest = std::max(greatest, small.velocity(body).norm());
    return greatest;
  }
  bool all_sleep() {
    return std::ranges::all_of(bodies, [&](BodyId body) { return small.world().is_asleep(body); });
  }
};

TEST_P(Heaps, AStackOfFortyBoxesStands) {
  description::World world = GetParam().world();
  world.physics.sleeping = false;
  Heap heap(world);
  for (int i = 0; i < 40; ++i) heap.add_box(Vector3d::Constant(0.1), 1.0, {0, 0, 0.05 + 0.1 * i});
  heap.small.run(60.0);
  EXPECT_LT(heap.furthest(), 2e-5);
  EXPECT_LT(heap.greatest_speed(), 1e-6);
}

TEST_P(Heaps, ABoxOf100000TimesTheMassStandsOnALightOne) {
  description::World world = GetParam().world();
  world.physics.sleeping = false;
  for (const double ratio : {1e3, 1e4, 1e5}) {
    SCOPED_TRACE(ratio);
    Heap heap(world);
    heap.add_box(Vector3d::Constant(0.1), 1.0 / ratio, {0, 0, 0.05});
    heap.add_box(Vector3d::Constant(0.1), 1.0, {0, 0, 0.15});
    heap.small.run(10.0);
    EXPECT_LT(heap.furthest(), 2e-6);
  }
}

// A vehicle on two driven wheels and two balls without friction.
struct DifferentialDrive {
  double mass = 8.0;
  Vector3d size{0.4, 0.26, 0.1};
  double height = 0.12;
  double wheel = 0.1;  // radius
  double wheel_mass = 0.5;
  double wheel_beside = 0.16;
  double ball = 0.03;  // radius
  double ball_ahead = 0.15;

  description::Model model() const {
    description::Model car;
    car.name = "car";
    car.links.push_back({"hull", {{0, 0, height}}, solid_box(mass, size), {{"body", {}, Box{size}, {0.5, 0.0}}}});
    for (const double x : {ball_ahead, -ball_ahead})
      car.links[0].collisions.push_back(
          {x > 0.0 ? "front" : "back", {{x, 0, ball - height}}, description::Sphere{ball}, {0.0, 0.0}});
    for (const double y : {wheel_beside, -wheel_beside}) add_wheel(car, {0, y, wheel}, wheel, 0.03, wheel_mass);
    for (const std::size_t joint : {std::size_t{0}, std::size_t{1}})
      car.devices.emplace_back(description::VelocityMotor{car.joints[joint].name, joint, 100.0, 5.0});
    return car;
  }
};

// One wheel of a differential drive of 9 kg rolls onto a marble of 10 g. A free marble carries the wheel but cannot
// drive it, so that the vehicle turns, as it does with steps of 1 ms.
TEST_P(Heaps, AWheelDoesNotPressAMarbleIntoTheFloor) {
  const auto yaw_after = [&](int milliseconds) {
    description::World world = GetParam().world(0.8);
    world.step = std::chrono::milliseconds(milliseconds);
    SmallWorld small(world);
    const auto body = small.add(DifferentialDrive{}.model(), at(0, 0, 0));
    const auto marble = small.add(loose("marble", description::Sphere{0.01}, solid_sphere(0.01, 0.01), {0.5, 0.0}),
                                  at(0.4, 0.16, 0.01));
    for (const std::size_t joint : {std::size_t{0}, std::size_t{1}})
      small.world().set_joint_target(body, JointId{joint}, physics::JointTarget::velocity(2.0));
    double lowest = 1.0;
    for (int i = 0; i < 4000 / milliseconds; ++i) {
      small.world().step();
      lowest = std::min(lowest, small.position(marble).z());
    }
    EXPECT_GT(lowest, 0.01 - 1e-3) << milliseconds << " ms";
    const Eigen::Quaterniond& orientation = small.world().link_pose(body, LinkId{0}).orientation;
    return 2.0 * std::atan2(orientation.z(), orientation.w());
  };
  const double fine = yaw_after(1);
  EXPECT_GT(fine, 1.0);
  EXPECT_NEAR(yaw_after(10), fine, 0.3);
}

// Marbles so large that the wheels push them instead of rolling onto them, at 0.2 m/s for 15 s.
TEST_P(Heaps, AVehiclePushesItsWayThrough200Marbles) {
  for (const double radius : {0.015, 0.02}) {
    SCOPED_TRACE(radius);
    SmallWorld small(GetParam().world(0.8));
    const DifferentialDrive car{.mass = 5.0,
                                .size = {0.25, 0.2, 0.06},
                                .height = 0.07,
                                .wheel = 0.05,
                                .wheel_mass = 0.3,
                                .wheel_beside = 0.12,
                                .ball = 0.025,
                                .ball_ahead = 0.1};
    const auto body = small.add(car.model(), at(0, 0, 0));
    const RandomStream random(3, "heap", "marbles");
    const double mass = 2500.0 * 4.0 / 3.0 * M_PI * radius * radius * radius;
    std::vector<BodyId> marbles;
    for (int i = 0; i < 200; ++i)
      marbles.push_back(small.add(loose("marble", description::Sphere{radius}, solid_sphere(mass, radius), {0.5, 0.0}),
                                  at(0.3 + 0.108 * (i / 8) + 0.065 * random.uniform(i, 0),
                                     0.1 * (i % 8) + 0.06 * random.uniform(i, 1) - 0.4, radius)));
    for (const std::size_t joint : {std::size_t{0}, std::size_t{1}})
      small.world().set_joint_target(body, JointId{joint}, physics::JointTarget::velocity(4.0));
    double lowest = radius;
    for (int i = 0; i < 1500; ++i) {
      small.world().step();
      for (const BodyId marble : marbles) lowest = std::min(lowest, small.position(marble).z());
    }
    EXPECT_GT(small.position(body).x(), 2.9);
    EXPECT_GT(lowest, radius - 1e-3);
  }
}

TEST_P(Heaps, APyramidOf55BoxesStands) {
  Heap heap(GetParam().world());
  for (int row = 0; row < 10; ++row)
    for (int i = 0; i < 10 - row; ++i)
      heap.add_box(Vector3d::Constant(0.1), 1.0, {0.105 * (i + 0.5 * row), 0, 0.05 + 0.1 * row});
  heap.small.run(20.0);
  EXPECT_LT(heap.furthest(), 2e-6);
  EXPECT_TRUE(heap.all_sleep());
}

// In stretcher bond, with half bricks at the ends of every second course, without gaps.
TEST_P(Heaps, AWallOf67BricksStands) {
  for (const bool sleeping : {true, false}) {
    SCOPED_TRACE(sleeping ? "may sleep" : "may not sleep");
    description::World world = GetParam().world();
    world.physics.sleeping = sleeping;
    Heap heap(world);
    for (int course = 0; course < 9; ++course) {
      const bool is_shifted = course % 2 == 1;
      for (int i = 0; i < (is_shifted ? 8 : 7); ++i) {
        const bool is_half = is_shifted && (i == 0 || i == 7);
        const double x = 0.2 * (i - (is_shifted ? 0.5 : 0.0)) + (is_half ? (i == 0 ? 0.05 : -0.05) : 0.0);
        heap.add_box({is_half ? 0.1 : 0.2, 0.1, 0.06}, is_half ? 1.0 : 2.0, {x, 0, 0.03 + 0.06 * course}, 0.6);
      }
    }
    heap.small.run(sleeping ? 20.0 : 4.0);
    EXPECT_LT(heap.furthest(), 5e-6);
    EXPECT_EQ(heap.all_sleep(), sleeping);
  }
}

// Bodies of different sizes that fall into a square of four walls; `half`: half its width.
void drop(Heap& heap, int count, bool hulls, double half = 0.5) {
  for (int side = 0; side < 4; ++side) {
    const double angle = 0.5 * M_PI * side;
    place(heap.small.description, static_shape("wall", Box{Vector3d(0.1, 2.0 * half + 0.4, 3.0)}, {0.5, 0.0}),
          "wall_" + std::to_string(side),
          turned((half + 0.05) * std::cos(angle), (half + 0.05) * std::sin(angle), 1.5, Vector3d::UnitZ(), angle));
  }
  const RandomStream random(3, "heap", hulls ? "hulls" : "boxes");
  const int edge = static_cast<int>(2.0 * half / 0.16);
  for (int i = 0; i < count; ++i) {
    std::uint32_t draw = 0;
    const auto next = [&] { return random.uniform(static_cast<std::uint64_t>(i), draw++); };
    const Vector3d size(0.06 + 0.05 * next(), 0.06 + 0.05 * next(), 0.06 + 0.05 * next());
    const Vector3d position(-half + 0.08 + 0.16 * (i % edge) + 0.01 * next(),
                            -half + 0.08 + 0.16 * (i / edge % edge) + 0.01 * next(), 0.1 + 0.17 * (i / edge / edge));
    Eigen::Quaterniond orientation(next() - 0.5, next() - 0.5, next() - 0.5, next() - 0.5);
    orientation.normalize();
    description::Shape shape = Box{size};
    if (hulls) {
      auto mesh = std::make_shared<description::TriangleMesh>(*box_mesh(size).triangles);
      for (Vector3d& vertex : mesh->vertices)
        for (int axis = 0; axis < 3; ++axis) vertex[axis] *= 0.7 + 0.3 * next();
      shape = description::Mesh{mesh, true};
    }
    heap.add(shape, solid_box(1000.0 * size.prod(), size), {position, orientation});
  }
}

TEST_P(Heaps, TwoHundredHullsComeToRest) {
  Heap heap(GetParam().world());
  drop(heap, 200, true);
  heap.small.run(15.0);
  EXPECT_TRUE(heap.all_sleep());
}

TEST_P(Heaps, TwoHundredBoxesComeToRest) {
  Heap heap(GetParam().world());
  drop(heap, 200, false);
  heap.small.run(15.0);
  EXPECT_TRUE(heap.all_sleep());
}

// With one dynamics: boxes have no joints, and 200 of them come to rest with both.
TEST(AThousandBoxes, ComeToRest) {
  Heap heap(treel.world());
  drop(heap, 1000, false, 0.8);
  heap.small.run(5.0);
  const auto moves = [&](BodyId body) { return heap.small.velocity(body).norm() > 1e-3; };
  EXPECT_LE(std::ranges::count_if(heap.bodies, moves), 10);
  for (int second = 5; second < 15 && !heap.all_sleep(); ++second) heap.small.run(1.0);
  EXPECT_TRUE(heap.all_sleep());
}

// Friction must balance the force and its moment at four points.
TEST_P(Heaps, ABoxThatIsPushedBesideItsCentreDoesNotCreep) {
  Heap heap(GetParam().world(0.5));
  heap.add_box({0.08, 0.06, 0.09}, 1.0, {0, 0, 0.045});
  const BodyId box = heap.bodies.front();
  const auto push_for = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      heap.small.world().push_body(box, LinkId{0}, {{3.0, 0, 0}, {0, 0, 0.09}});  // friction resists up to 4.9 N
      heap.small.world().step();
    }
  };
  push_for(100);
  const Pose before = heap.small.world().link_pose(box, LinkId{0});
  push_for(1000);
  const Pose after = heap.small.world().link_pose(box, LinkId{0});
  EXPECT_LT((after.position - before.position).norm(), 1e-8);
  EXPECT_LT(after.orientation.angularDistance(before.orientation), 1e-7);
}

TEST_P(Heaps, HaveTheSameBitsForAnyNumberOfThreadsAndAfterARestore) {
  const auto hash_after = [&](bool are_hulls, unsigned threads, bool restores) {
    Heap heap(GetParam().world(), threads);
    drop(heap, 120, are_hulls);
    heap.small.run(1.5);
    if (!restores) {
      heap.small.run(1.0);
      return hash_of(heap.small.world());
    }
    WorkerPool workers(2);
    const auto restored = physics::make_world(heap.small.description, workers);
    restore_from(heap.small.world(), *restored);
    for (int i = 0; i < 100; ++i) restored->step();
    return hash_of(*restored);
  };
  for (const bool are_hulls : {true, false}) {
    SCOPED_TRACE(are_hulls ? "hulls" : "boxes");
    const std::uint64_t expected = hash_after(are_hulls, 1, false);
    for (const unsigned threads : {2u, 3u}) EXPECT_EQ(hash_after(are_hulls, threads, false), expected) << threads;
    EXPECT_EQ(hash_after(are_hulls, 1, true), expected) << "restored";
  }
}

}  // namespace
}  // namespace cohort::test
