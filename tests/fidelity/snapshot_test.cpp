#include <gtest/gtest.h>

#include "tests/support/small_world.hpp"

namespace cohort::test {
namespace {

using Eigen::Vector3d;

std::uint64_t hash_of(const physics::World& world) {
  StateHash hash;
  for (std::uint32_t body = 0; body < world.body_count(); ++body) world.hash_body(body, hash);
  world.hash_contacts(hash);
  return hash.value();
}

// All that has a state: robots that push each other, loose things of shapes with and without a closed form of contact,
// joints with limits and friction.
description::World busy_world() {
  description::World world = world_with_floor();
  for (int row = 0; row < 4; ++row)
    for (int i = 0; i < 4; ++i)
      place(world, tracked_robot(), "robot_" + std::to_string(4 * row + i), at(0.14 * i, 0.14 * row, 0, 0.7 * i + row));
  auto hull = std::make_shared<description::TriangleMesh>();
  hull->vertices = {{0, 0, 0.1}, {0.1, 0, -0.05}, {-0.05, 0.09, -0.05}, {-0.05, -0.09, -0.05}};
  for (int i = 0; i < 6; ++i) {
    const description::Shape shapes[] = {description::Sphere{0.05}, description::Mesh{hull, true},
                                         description::Ellipsoid{{0.08, 0.06, 0.05}}};
    place(world, loose("loose_" + std::to_string(i), shapes[i % 3], solid_sphere(0.2, 0.06)),
          "loose_" + std::to_string(i), at(-0.12 - 0.01 * i, 0.1 * (i % 3), i < 3 ? 0.1 : 0.25));
  }
  return world;
}

void drive(physics::World& world, int tick) {
  for (std::uint32_t body = 1; body <= 16; ++body) {
    if (!world.is_active(body)) continue;
    const double turn = 0.05 * std::sin(0.03 * tick + body);
    world.set_track_velocity_target(body, 0, physics::Side::left, -0.1 + turn);
    world.set_track_velocity_target(body, 0, physics::Side::right, -0.1 - turn);
    world.set_joint_velocity_target(body, 0, 0.5);
  }
}

TEST(Snapshot, AWorldRestoredGoesOnWithTheSameBits) {
  for (const description::Solver solver : {description::Solver::iterative, description::Solver::hybrid}) {
    description::World description = busy_world();
    description.physics.solver = solver;
    WorkerPool workers(1);
    const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
    const std::uint32_t bond = world->connect(1, 1, {{0.07, 0, 0}}, 2, 1, {.force = 50.0});
    world->connect(3, 1, {{0.07, 0, 0}}, 4, 1);
    for (int tick = 0; tick < 150; ++tick) {
      drive(*world, tick);
      world->step();
      if (tick == 50) world->remove_body(9);
      if (tick == 60) world->add_body(1, at(-0.5, -0.5, 0));
      if (tick == 70) world->disconnect(bond);
    }
    SnapshotWriter writer;
    world->save(writer);

    WorkerPool others(2);
    const std::unique_ptr<physics::World> restored = physics::make_world(description, others);
    SnapshotReader reader(writer.bytes());
    restored->restore(reader);
    EXPECT_TRUE(reader.is_at_end());
    ASSERT_EQ(hash_of(*restored), hash_of(*world));
    ASSERT_EQ(restored->contacts().size(), world->contacts().size());
    EXPECT_GT(world->contacts().size(), 10u) << "there is something to keep";
    for (int tick = 150; tick < 300; ++tick) {
      drive(*world, tick);
      drive(*restored, tick);
      world->step();
      restored->step();
      ASSERT_EQ(hash_of(*restored), hash_of(*world)) << "at tick " << tick;
    }
  }
}

TEST(Snapshot, OfAnotherWorldOrCutOffIsRefused) {
  const description::World description = busy_world();
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  world->step();
  SnapshotWriter writer;
  world->save(writer);

  const description::World other = world_with_floor();
  const std::unique_ptr<physics::World> another = physics::make_world(other, workers);
  SnapshotReader reader(writer.bytes());
  EXPECT_THROW(another->restore(reader), SnapshotError);
  for (const std::size_t length : {std::size_t{0}, writer.bytes().size() / 2, writer.bytes().size() - 1}) {
    const std::unique_ptr<physics::World> cut = physics::make_world(description, workers);
    SnapshotReader short_reader(std::span(writer.bytes()).first(length));
    EXPECT_THROW(cut->restore(short_reader), SnapshotError) << length << " bytes";
  }
}

}  // namespace
}  // namespace cohort::test
