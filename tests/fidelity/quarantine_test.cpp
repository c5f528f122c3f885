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

TEST(Falling, ABodyThatFallsOutOfTheWorldIsRemoved) {
  SmallWorld small;
  small.description.instances.clear();
  small.description.models.clear();
  small.add(static_shape("table", Box{{1, 1, 0.1}}), at(0, 0, 0));
  const auto ball = small.add(loose("ball", description::Sphere{0.05}, solid_sphere(1, 0.05)), at(2, 0, 0.5));
  const auto rests = small.add(loose("ball", description::Sphere{0.05}, solid_sphere(1, 0.05)), at(0, 0, 0.1));
  int quarantined = 0;
  for (int i = 0; i < 300; ++i) {
    small.world().step();
    for (const physics::Quarantine& event : small.world().quarantined()) {
      EXPECT_EQ(event.body, ball);
      EXPECT_EQ(event.reason, physics::Quarantine::Reason::left_world);
      ++quarantined;
    }
  }
  EXPECT_EQ(quarantined, 1);
  EXPECT_NEAR(small.position(ball).z(), -10.0, 1.0) << "ten metres below everything";
  EXPECT_TRUE(small.world().is_active(rests));
}

}  // namespace
}  // namespace cohort::test
