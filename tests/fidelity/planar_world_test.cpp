#include <gtest/gtest.h>

#include "tests/support/small_world.hpp"

// What a world keeps to with planar bodies as with any others: the same bits, snapshots, quarantine, and what it
// refuses.
namespace cohort::test {
namespace {

using description::Box;
using Eigen::Vector3d;

std::uint64_t hash_of(const physics::World& world) {
  StateHash hash;
  for (std::uint32_t body = 0; body < world.body_count(); ++body) world.hash_body(body, hash);
  world.hash_contacts(hash);
  return hash.value();
}

description::World planar_world() {
  description::World world = world_with_floor();
  world.physics.fidelity = description::Fidelity::planar;
  return world;
}

// Robots and loose things that push each other, between walls.
constexpr std::uint32_t robot_count = 150;
description::World busy_world() {
  description::World world = planar_world();
  for (std::uint32_t i = 0; i < robot_count; ++i)
    place(world, tracked_robot(), "robot_" + std::to_string(i), at(0.14 * (i % 12), 0.14 * (i / 12), 0, 0.7 * i));
  for (int i = 0; i < 12; ++i) {
    const description::Shape shapes[] = {description::Cylinder{0.05, 0.1}, Box{{0.1, 0.06, 0.1}},
                                         description::Ellipsoid{{0.08, 0.06, 0.05}}};
    place(world, loose("loose_" + std::to_string(i), shapes[i % 3], solid_sphere(0.2, 0.06)),
          "loose_" + std::to_string(i), at(-0.15, 0.14 * i, 0.05, 0.3 * i));
  }
  place(world, static_shape("wall", Box{{0.1, 3, 0.3}}), "wall", at(-0.4, 0.8, 0.15));
  return world;
}

void drive(physics::World& world, int tick) {
  for (std::uint32_t body = 1; body <= robot_count; ++body) {
    if (!world.is_active(body)) continue;
    const double turn = 0.05 * std::sin(0.03 * tick + body);
    world.set_track_velocity_target(body, 0, physics::Side::left, -0.1 + turn);
    world.set_track_velocity_target(body, 0, physics::Side::right, -0.1 - turn);
    world.set_joint_velocity_target(body, 0, 0.5);
  }
}

TEST(PlanarWorld, HasTheSameBitsForAnyNumberOfThreads) {
  const description::World description = busy_world();
  const auto hash_with = [&](unsigned threads) {
    WorkerPool workers(threads);
    const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
    world->connect(3, 1, {{0.07, 0, 0}}, 4, 1);
    for (int tick = 0; tick < 300; ++tick) {
      drive(*world, tick);
      world->step();
      if (tick == 100) world->remove_body(7);
      if (tick == 120) world->add_body(1, at(-0.8, -0.5, 0));
    }
    EXPECT_FALSE(world->is_active(7));
    return hash_of(*world);
  };
  const std::uint64_t expected = hash_with(1);
  EXPECT_EQ(hash_with(2), expected);
  EXPECT_EQ(hash_with(4), expected);
}

TEST(PlanarWorld, RestoredFromASnapshotGoesOnWithTheSameBits) {
  const description::World description = busy_world();
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  const std::uint32_t bond = world->connect(1, 1, {{0.07, 0, 0}}, 2, 1, {.force = 50.0});
  world->connect(3, 1, {{0.07, 0, 0}}, 4, 1);
  for (int tick = 0; tick < 150; ++tick) {
    drive(*world, tick);
    world->step();
    if (tick == 50) world->remove_body(9);
    if (tick == 60) world->add_body(1, at(-0.8, -0.5, 0));
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

TEST(PlanarWorld, RefusesASnapshotThatIsCutOffOrOfAnotherWorld) {
  const description::World description = busy_world();
  WorkerPool workers(1);
  const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
  world->step();
  SnapshotWriter writer;
  world->save(writer);
  const description::World other = planar_world();
  const std::unique_ptr<physics::World> another = physics::make_world(other, workers);
  SnapshotReader reader(writer.bytes());
  EXPECT_THROW(another->restore(reader), SnapshotError);
  for (const std::size_t length : {std::size_t{0}, writer.bytes().size() / 2, writer.bytes().size() - 1}) {
    const std::unique_ptr<physics::World> cut = physics::make_world(description, workers);
    SnapshotReader short_reader(std::span(writer.bytes()).first(length));
    EXPECT_THROW(cut->restore(short_reader), SnapshotError) << length << " bytes";
  }
}

// A dozen robots that drive about and push each other.
struct Crowd {
  SmallWorld small{planar_world()};
  std::vector<std::uint32_t> robots;

  Crowd() {
    for (int i = 0; i < 12; ++i) robots.push_back(small.add(tracked_robot(), at(0.13 * (i % 4), 0.13 * (i / 4), 0, i)));
  }
  void set_off() {
    for (const std::uint32_t robot : robots) small.drive(robot, 0.1, 0.1 + 0.005 * robot);
  }
  std::uint64_t hash() {
    StateHash hash;
    for (const std::uint32_t robot : robots) small.world().hash_body(robot, hash);
    return hash.value();
  }
};

TEST(PlanarWorld, AnExplodingBodyIsTakenOutAndTheOthersNeverNotice) {
  Crowd undisturbed;
  undisturbed.small.add(tracked_robot(), at(3, 3, 0));
  undisturbed.set_off();
  undisturbed.small.run(3.0);

  Crowd disturbed;
  const auto bomb = disturbed.small.add(tracked_robot(), at(3, 3, 0));
  disturbed.set_off();
  disturbed.small.run(1.0);
  disturbed.small.world().set_root_twist(bomb, {Vector3d(0, 0, 1e300), Vector3d(0, 1e300, 0)});
  disturbed.small.world().step();
  ASSERT_EQ(disturbed.small.world().quarantined().size(), 1u);
  EXPECT_EQ(disturbed.small.world().quarantined()[0].body, bomb);
  EXPECT_EQ(disturbed.small.world().quarantined()[0].reason, physics::Quarantine::Reason::not_finite);
  EXPECT_FALSE(disturbed.small.world().is_active(bomb));
  EXPECT_TRUE(disturbed.small.position(bomb).allFinite());
  disturbed.small.run(1.99);
  EXPECT_TRUE(disturbed.small.world().quarantined().empty());
  EXPECT_EQ(disturbed.hash(), undisturbed.hash());
}

TEST(PlanarWorld, ABodyThatBreaksWhileItTouchesOthersLeavesThemWhole) {
  Crowd crowd;
  crowd.set_off();
  crowd.small.run(1.0);
  crowd.small.world().set_root_twist(crowd.robots[5], {Vector3d::Constant(std::nan("")), Vector3d::Zero()});
  crowd.small.run(2.0);
  for (const std::uint32_t robot : crowd.robots) {
    EXPECT_EQ(crowd.small.world().is_active(robot), robot != crowd.robots[5]);
    EXPECT_TRUE(crowd.small.position(robot).allFinite());
    EXPECT_LT(crowd.small.velocity(robot).norm(), 1.0);
  }
}

TEST(PlanarWorld, ABodyThatGoesTooFarHasLeftTheWorld) {
  SmallWorld small(planar_world());
  small.description.models[0].links[0].collisions[0].surface.friction = 0.0;
  const auto puck = small.add(loose("puck", Box{{0.1, 0.1, 0.1}}, solid_box(1, {0.1, 0.1, 0.1})), at(999990, 0, 0.05));
  small.world().set_root_twist(puck, {Vector3d::Zero(), Vector3d(100, 0, 0)});
  small.run(0.05);
  EXPECT_TRUE(small.world().is_active(puck));
  small.run(0.2);
  EXPECT_FALSE(small.world().is_active(puck));
}

// The message with which a world is refused.
std::string refusal_of(const description::World& world) {
  WorkerPool workers(1);
  try {
    const std::unique_ptr<physics::World> refused = physics::make_world(world, workers);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(PlanarWorld, RefusesWhatCannotBePlanarByTheNameOfItsModel) {
  description::World leaning = planar_world();
  place(leaning, tracked_robot(), "robot", turned(0, 0, 0, Vector3d::UnitX(), 0.002));
  EXPECT_EQ(refusal_of(leaning), "model 'tracked_robot': a robot that leans cannot be planar");

  description::World slope = planar_world();
  slope.instances[0].X_WM = turned(0, 0, 0, Vector3d::UnitX(), 0.1);
  EXPECT_EQ(refusal_of(slope), "model 'floor': a plane that is neither level nor upright cannot be planar");

  description::World moon = planar_world();
  moon.gravity = {0.0, 1.0, -1.6};
  EXPECT_EQ(refusal_of(moon), "planar physics needs gravity along -z");

  description::World door = planar_world();
  description::Model hinged = loose("door", Box{{1, 0.1, 1}}, solid_box(1, {1, 0.1, 1}));
  description::Joint hinge;
  hinge.type = description::JointType::revolute;
  hinge.parent = description::Joint::world;
  hinge.child = 0;
  hinged.joints.push_back(hinge);
  place(door, hinged, "door", at(0, 0, 0.5));
  EXPECT_EQ(refusal_of(door), "model 'door': a joint that moves against the world cannot be planar");

  description::World hole = planar_world();
  hole.instances.clear();
  place(hole, tracked_robot(), "robot", at(0, 0, 0));
  EXPECT_EQ(refusal_of(hole), "model 'tracked_robot': there is no ground under it, so it cannot be planar");
}

TEST(PlanarWorld, ABodyAddedWhereThereIsNoGroundIsRefusedAndTheWorldGoesOn) {
  SmallWorld small(planar_world());
  small.description.models.clear();
  small.description.instances.clear();
  small.add(static_shape("table", Box{{2, 2, 0.1}}), at(0, 0, -0.05));
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  EXPECT_THROW(small.world().add_body(1, at(5, 0, 0)), std::invalid_argument);
  small.drive(robot, 0.1, 0.1);
  small.run(1.0);
  EXPECT_GT(small.position(robot).x(), 0.09);
}

TEST(PlanarWorld, ABodyFixedToTheWorldStaysAndIsInTheWay) {
  SmallWorld small(planar_world());
  description::Model post = loose("post", Box{{0.1, 0.1, 0.2}}, solid_box(1, {0.1, 0.1, 0.2}));
  description::Joint weld;
  weld.type = description::JointType::fixed;
  weld.parent = description::Joint::world;
  weld.child = 0;
  post.joints.push_back(weld);
  const auto fixed = small.add(post, at(0.25, 0, 0.1, 0.2));
  const auto robot = small.add(tracked_robot(), at(0, 0, 0));
  const Vector3d before = small.position(fixed);
  small.drive(robot, 0.1, 0.1);
  small.run(2.0);
  EXPECT_EQ(small.position(fixed), before);
  EXPECT_LT(small.position(robot).x(), 0.15);
}

}  // namespace
}  // namespace cohort::test
