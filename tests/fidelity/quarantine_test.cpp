// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using Eigen::Vector3d;

// A dozen robots that drive and push each other.
struct Crowd {
  SmallWorld small;
  std::vector<BodyId> robots;

  explicit Crowd(const Physics& physics) : small(physics.world()) {
    for (int i = 0; i < 12; ++i) robots.push_back(small.add(physics.robot(), at(0.13 * (i % 4), 0.13 * (i / 4), 0, i)));
  }
  void set_off() {
    for (const BodyId robot : robots) small.drive(robot, 0.1, 0.1 + 0.005 * robot.value);
  }
};

class Quarantine : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, Quarantine, every_physics, name_of);

TEST_P(Quarantine, AnExplodingBodyIsRemovedWithoutEffectOnOthers) {
  Crowd undisturbed(GetParam());
  undisturbed.small.add(GetParam().robot(), at(3, 3, 0));
  undisturbed.set_off();
  undisturbed.small.run(3.0);

  Crowd disturbed(GetParam());
  const auto bomb = disturbed.small.add(GetParam().robot(), at(3, 3, 0));
  disturbed.set_off();
  disturbed.small.run(1.0);
  disturbed.small.world().set_root_twist(bomb, {Vector3d(1e200, 0, 1e300), Vector3d(0, 1e300, 0)});
  disturbed.small.world().step();
  ASSERT_EQ(disturbed.small.world().quarantined().size(), 1u);
  EXPECT_EQ(disturbed.small.world().quarantined()[0].body, bomb);
  EXPECT_EQ(disturbed.small.world().quarantined()[0].reason, physics::Quarantine::Reason::not_finite);
  EXPECT_FALSE(disturbed.small.world().is_active(bomb));
  EXPECT_TRUE(disturbed.small.position(bomb).allFinite());
  disturbed.small.run(1.99);
  EXPECT_TRUE(disturbed.small.world().quarantined().empty());
  EXPECT_EQ(hash_of(disturbed.small.world(), disturbed.robots), hash_of(undisturbed.small.world(), undisturbed.robots));
}

TEST_P(Quarantine, ABodyThatBreaksInContactDoesNotBreakOthers) {
  Crowd crowd(GetParam());
  crowd.set_off();
  crowd.small.run(1.0);
  crowd.small.world().set_root_twist(crowd.robots[5], {Vector3d::Constant(std::nan("")), Vector3d::Zero()});
  crowd.small.run(2.0);
  for (const BodyId robot : crowd.robots) {
    EXPECT_EQ(crowd.small.world().is_active(robot), robot != crowd.robots[5]);
    EXPECT_TRUE(crowd.small.position(robot).allFinite());
    EXPECT_LT(crowd.small.velocity(robot).norm(), 1.0);
  }
}

TEST_P(Quarantine, ABodyTooFarAwayHasLeftTheWorld) {
  SmallWorld small(GetParam().world(0.0));
  const auto puck = small.add(loose("puck", Box{{0.1, 0.1, 0.1}}, solid_box(1, {0.1, 0.1, 0.1})), at(999990, 0, 0.05));
  small.world().set_root_twist(puck, {Vector3d::Zero(), Vector3d(100, 0, 0)});
  small.run(0.05);
  EXPECT_TRUE(small.world().is_active(puck));
  small.run(0.2);
  EXPECT_FALSE(small.world().is_active(puck));
}

// A world in which nothing limits the fall of a body yet.
class Falling : public EveryPhysics {
 protected:
  static description::World nothing() {
    description::World world = GetParam().world();
    world.models.clear();
    world.instances.clear();
    return world;
  }
  static description::Model ball() { return loose("ball", description::Sphere{0.05}, solid_sphere(1, 0.05)); }
  static description::Model table() { return static_shape("table", Box{{1, 1, 0.1}}); }
};
INSTANTIATE_TEST_SUITE_P(Every, Falling,
                         ::testing::Values(articulated, by_bullet(articulated), treel, by_bullet(treel)), name_of);

TEST_P(Falling, ABodyThatFallsOutOfTheWorldIsRemoved) {
  SmallWorld small(nothing());
  small.add(table(), at(0, 0, 0));
  const auto falling = small.add(ball(), at(2, 0, 0.5));
  const auto rests = small.add(ball(), at(0, 0, 0.1));
  int quarantined = 0;
  for (int i = 0; i < 300; ++i) {
    small.world().step();
    for (const physics::Quarantine& event : small.world().quarantined()) {
      EXPECT_EQ(event.body, falling);
      EXPECT_EQ(event.reason, physics::Quarantine::Reason::left_world);
      ++quarantined;
    }
  }
  EXPECT_EQ(quarantined, 1);
  EXPECT_NEAR(small.position(falling).z(), -10.0, 1.0) << "ten metres below everything";
  EXPECT_TRUE(small.world().is_active(rests));
}

// After n steps of h, semi-implicit Euler has fallen g h² n (n + 1) / 2.
TEST_P(Falling, ABodyFallsWithoutLimitWhereThereIsNoGround) {
  SmallWorld small(nothing());
  const auto falling = small.add(ball(), at(0, 0, 0));
  const auto lower = small.add(ball(), at(1, 0, -20));
  small.run(20.0);
  const double fallen = g * 0.01 * 0.01 * 2000.0 * 2001.0 / 2.0;
  EXPECT_TRUE(small.world().is_active(falling));
  EXPECT_NEAR(small.position(falling).z(), -fallen, 1e-6 * fallen);
  EXPECT_NEAR(small.position(lower).z(), -20.0 - fallen, 1e-6 * fallen);
}

TEST_P(Falling, ABodyLandsOnGroundThatIsAddedOrMovedFarBelow) {
  for (const bool is_moved : {false, true}) {
    SmallWorld small(nothing());
    const auto above = small.add(table(), at(5, 0, 0));
    const auto falling = small.add(ball(), at(0, 0, 0.5));
    small.run(0.5);
    if (is_moved)
      small.world().place_body(above, at(0, 0, -30));
    else
      small.world().add_body(small.world().model_of(above), at(0, 0, -30));
    small.run(5.0);
    EXPECT_TRUE(small.world().is_active(falling));
    EXPECT_NEAR(small.position(falling).z(), -29.9, 1e-3);
  }
}

TEST_P(Falling, ABodyBelowAllGroundFallsTenMetres) {
  SmallWorld small(nothing());
  small.add(table(), at(0, 0, 0));
  const auto falling = small.add(ball(), at(2, 0, -20));
  small.run(1.4);
  EXPECT_TRUE(small.world().is_active(falling)) << "9.6 m";
  small.run(0.1);
  EXPECT_FALSE(small.world().is_active(falling)) << "11 m";
}

TEST_P(Falling, ABodySlidesDownAPlaneWithoutLimit) {
  SmallWorld small(nothing());
  small.add(static_shape("slope", description::Plane{}, {0.0, 0.0}), turned(0, 0, 0, {0, 1, 0}, 0.5));
  small.add(table(), at(0, 5, 10));
  const double along = std::sin(0.5);
  const auto box = small.add(loose("box", Box{{0.1, 0.1, 0.1}}, solid_box(1, {0.1, 0.1, 0.1})),
                             turned(0.05 * along, 0, 0.05 * std::cos(0.5), {0, 1, 0}, 0.5));
  small.run(5.0);
  EXPECT_TRUE(small.world().is_active(box));
  EXPECT_NEAR(small.position(box).z(), -0.5 * g * 25.0 * along * along, 0.3) << "28 m lower";
}

// The limit does not depend on what else has happened, so a run that is restored removes a body in the same step.
TEST_P(Falling, TheLimitIsTheSameAfterARestore) {
  const auto place_table_and_ball = [](SmallWorld& small) {
    small.add(table(), at(0, 0, 0));
    return small.add(ball(), at(2, 0, 0.5));
  };
  SmallWorld small(nothing());
  const auto falling = place_table_and_ball(small);
  small.run(0.5);
  small.world().place_body(BodyId{0}, at(0, 0, -15));
  SmallWorld restored(nothing());
  place_table_and_ball(restored);
  restored.run(0.01);
  restore_from(small.world(), restored.world());
  while (small.world().is_active(falling)) {
    small.world().step();
    restored.world().step();
    ASSERT_EQ(hash_of(small.world()), hash_of(restored.world()));
  }
  EXPECT_NEAR(small.position(falling).z(), -25.0, 0.5);
}

TEST(PlanarFalling, ABodyFarBelowOtherGroundStays) {
  description::World world = planar.world();
  world.models.clear();
  world.instances.clear();
  SmallWorld small(world);
  small.add(static_shape("table", Box{{1, 1, 0.1}}), at(0, 0, 0));
  small.add(static_shape("basement", Box{{1, 1, 0.1}}), at(5, 0, -30));
  const auto puck = small.add(loose("puck", Box{{0.1, 0.1, 0.1}}, solid_box(1, {0.1, 0.1, 0.1})), at(5, 0, -29.9));
  small.run(0.5);
  EXPECT_TRUE(small.world().is_active(puck));
  EXPECT_NEAR(small.position(puck).z(), -29.9, 1e-9);
}

}  // namespace
}  // namespace cohort::test
