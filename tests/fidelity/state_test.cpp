// SPDX-License-Identifier: Apache-2.0

// The state of a world with any physics has the same bits for any number of threads, and after a snapshot is restored.

#include <gtest/gtest.h>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

// A world with every kind of state. It has robots that push each other, loose bodies with and without closed forms of
// contact, and a wall. It also has joints with limits and friction, and robots that are connected, removed and put
// back.
struct BusyWorld {
  SmallWorld small;
  std::uint32_t robots;
  ConnectionId bond;
  BodyId added;

  BusyWorld(const Physics& physics, unsigned threads)
      : small(physics.world(), threads), robots(physics == planar ? 150 : 60) {  // several for each thread
    for (std::uint32_t i = 0; i < robots; ++i)
      small.add(physics.robot(), at(0.14 * (i % 12), 0.14 * (i / 12), 0, 0.7 * i));
    auto hull = std::make_shared<description::TriangleMesh>();
    hull->vertices = {{0, 0, 0.1}, {0.1, 0, -0.05}, {-0.05, 0.09, -0.05}, {-0.05, -0.09, -0.05}};
    const description::Shape shapes[] = {description::Cylinder{0.05, 0.1}, description::Box{{0.1, 0.06, 0.1}},
                                         description::Ellipsoid{{0.08, 0.06, 0.05}}, description::Sphere{0.05},
                                         description::Mesh{hull, true}};
    for (int i = 0; i < 12; ++i)
      small.add(loose("loose", shapes[i % (physics == planar ? 3 : 5)], solid_sphere(0.2, 0.06)),
                at(-0.15, 0.14 * i, physics == planar || i % 2 == 0 ? 0.05 : 0.25, 0.3 * i));
    small.add(static_shape("wall", description::Box{{0.1, 3, 0.3}}), at(-0.4, 0.8, 0.15));
  }
  void step(int tick) {
    if (tick == 0) {
      bond = small.world().connections().connect({BodyId{1}, LinkId{turret}}, {{0.07, 0, 0}},
                                                 {BodyId{2}, LinkId{turret}}, {.force = 50.0});
      small.world().connections().connect({BodyId{3}, LinkId{turret}}, {{0.07, 0, 0}}, {BodyId{4}, LinkId{turret}});
    }
    if (tick == 50) small.world().set_present(BodyId{9}, false);
    if (tick == 60) added = small.world().add_body(1, at(-0.8, -0.5, 0));
    if (tick == 70) small.world().connections().disconnect(bond);
    for (std::uint32_t index = 1; index < small.world().body_count(); ++index) {
      const BodyId body{index};
      if (!small.world().is_active(body) || (index > robots && body != added)) continue;
      const double turn = 0.05 * std::sin(0.03 * tick + index);
      small.drive(body, -0.1 + turn, -0.1 - turn);
      small.world().set_joint_target(body, JointId{0}, physics::JointTarget::velocity(0.5));
    }
    small.world().step();
  }
};

class State : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, State, every_physics, name_of);

TEST_P(State, HasTheSameBitsForAnyNumberOfThreads) {
  const auto hash_with = [](unsigned threads) {
    BusyWorld busy(GetParam(), threads);
    for (int tick = 0; tick < 300; ++tick) busy.step(tick);
    EXPECT_FALSE(busy.small.world().is_active(BodyId{9}));
    EXPECT_EQ(busy.added.value, busy.small.description.instances.size());
    EXPECT_GT((busy.small.position(busy.added) - Eigen::Vector3d(-0.8, -0.5, 0)).norm(), 0.05);
    return hash_of(busy.small.world());
  };
  const std::uint64_t expected = hash_with(1);
  for (const unsigned threads : {2u, 3u}) EXPECT_EQ(hash_with(threads), expected) << threads;
}

TEST_P(State, ContinuesFromASnapshotWithTheSameBits) {
  BusyWorld busy(GetParam(), 1);
  for (int tick = 0; tick < 150; ++tick) busy.step(tick);
  BusyWorld restored(GetParam(), 2);
  restored.small.world().add_body(1, at(-0.8, -0.5, 0), busy.small.world().slot_of(busy.added));
  restore_from(busy.small.world(), restored.small.world());
  restored.added = busy.added;
  ASSERT_EQ(hash_of(restored.small.world()), hash_of(busy.small.world()));
  ASSERT_EQ(restored.small.world().contacts().size(), busy.small.world().contacts().size());
  EXPECT_GT(busy.small.world().contacts().size(), 10u) << "there is something to keep";
  for (int tick = 150; tick < 300; ++tick) {
    busy.step(tick);
    restored.step(tick);
    ASSERT_EQ(hash_of(restored.small.world()), hash_of(busy.small.world())) << "at tick " << tick;
  }
}

TEST_P(State, OfAnotherWorldOrTruncatedIsRejected) {
  BusyWorld busy(GetParam(), 1);
  busy.step(0);
  SnapshotWriter writer;
  busy.small.world().save(writer);
  SmallWorld another(GetParam().world());
  SnapshotReader reader(writer.bytes());
  EXPECT_THROW(another.world().restore(reader), SnapshotError);
  for (const std::size_t length : {std::size_t{0}, writer.bytes().size() / 2, writer.bytes().size() - 1}) {
    BusyWorld cut(GetParam(), 1);
    SnapshotReader short_reader(std::span(writer.bytes()).first(length));
    EXPECT_THROW(cut.small.world().restore(short_reader), SnapshotError) << length << " bytes";
  }
}

}  // namespace
}  // namespace cohort::test
