#include <gtest/gtest.h>

#include "tests/support/small_world.hpp"

namespace cohort::test {
namespace {

using description::Box;
using Eigen::Vector3d;

std::uint64_t hash_of(const physics::World& world, std::span<const std::uint32_t> bodies) {
  StateHash hash;
  for (const std::uint32_t body : bodies) world.hash_body(body, hash);
  return hash.value();
}

// A dozen robots that drive about and push each other; `spare` is one more, off to the side.
struct Crowd {
  SmallWorld small;
  std::vector<std::uint32_t> robots;

  Crowd() {
    for (int row = 0; row < 3; ++row)
      for (int i = 0; i < 4; ++i)
        robots.push_back(small.add(tracked_robot(), at(0.13 * i, 0.13 * row, 0, 4 * row + i)));
  }
  void set_off() {
    for (const std::uint32_t robot : robots) small.drive(robot, 0.1, 0.1 + 0.005 * robot);
  }
};

TEST(Quarantine, AnExplodingBodyIsTakenOutAndTheOthersNeverNotice) {
  Crowd undisturbed;
  undisturbed.small.add(tracked_robot(), at(3, 3, 0));
  undisturbed.set_off();
  undisturbed.small.run(3.0);

  Crowd disturbed;
  const auto bomb = disturbed.small.add(tracked_robot(), at(3, 3, 0));
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

TEST(Quarantine, ABodyThatBreaksWhileItTouchesOthersLeavesThemWhole) {
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

TEST(Quarantine, ABodyThatFallsOutOfTheWorldIsTakenOut) {
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

TEST(Population, RobotsComeAndGoInMidRunTheSameForAnyNumberOfWorkers) {
  const auto hash_with = [](unsigned threads) {
    description::World description = world_with_floor();
    for (int i = 0; i < 20; ++i) place(description, tracked_robot(), "r" + std::to_string(i), at(0.13 * i, 0, 0, i));
    WorkerPool workers(threads);
    const std::unique_ptr<physics::World> world = physics::make_world(description, workers);
    const auto drive = [&](std::uint32_t body) {
      world->set_track_velocity_target(body, 0, physics::Side::left, 0.1);
      world->set_track_velocity_target(body, 0, physics::Side::right, 0.12);
    };
    for (std::uint32_t body = 1; body <= 20; ++body) drive(body);
    for (int i = 0; i < 100; ++i) world->step();
    world->remove_body(7);
    const std::uint32_t added = world->add_body(1, at(0.5, 0.3, 0));
    drive(added);
    for (int i = 0; i < 100; ++i) world->step();
    EXPECT_EQ(added, 21u);
    EXPECT_FALSE(world->is_active(7));
    EXPECT_GT((world->link_pose(added, 0).position - Vector3d(0.5, 0.3, 0)).norm(), 0.05);
    StateHash hash;
    for (std::uint32_t body = 0; body < world->body_count(); ++body) world->hash_body(body, hash);
    world->hash_contacts(hash);
    return hash.value();
  };
  const std::uint64_t expected = hash_with(1);
  EXPECT_EQ(hash_with(2), expected);
  EXPECT_EQ(hash_with(4), expected);
}

}  // namespace
}  // namespace cohort::test
