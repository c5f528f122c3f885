// SPDX-License-Identifier: Apache-2.0

// Sleeping bodies cost nothing, and wake as if they had never slept.

#include <gtest/gtest.h>

#include <ctime>
#include <functional>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

constexpr double edge = 0.1;  // edge of the boxes [m]

description::Model small_box(double mass = 1.0) {
  const Eigen::Vector3d size = Eigen::Vector3d::Constant(edge);
  return loose("box", description::Box{size}, solid_box(mass, size));
}

// Adds a stack of boxes at x; returns them from the bottom up.
std::vector<BodyId> add_stack(SmallWorld& small, double x, int boxes, double mass = 1.0) {
  std::vector<BodyId> stack;
  stack.reserve(static_cast<std::size_t>(boxes));
  for (int i = 0; i < boxes; ++i) stack.push_back(small.add(small_box(mass), at(x, 0, edge * (0.5 + i))));
  return stack;
}

bool all_sleep(SmallWorld& small, const std::vector<BodyId>& bodies) {
  return std::ranges::all_of(bodies, [&](BodyId body) { return small.world().is_asleep(body); });
}
bool none_sleeps(SmallWorld& small, const std::vector<BodyId>& bodies) {
  return std::ranges::none_of(bodies, [&](BodyId body) { return small.world().is_asleep(body); });
}

class Sleeping : public EveryPhysics {
 protected:
  SmallWorld floor(bool sleeping = true) {
    description::World world = GetParam().world();
    world.physics.sleeping = sleeping;
    return SmallWorld(world);
  }
};
INSTANTIATE_TEST_SUITE_P(Every, Sleeping, ::testing::Values(treel, by_bullet(treel)), name_of);

TEST_P(Sleeping, AnIslandThatIsStillForHalfASecondSleeps) {
  SmallWorld small = floor();
  const auto stack = add_stack(small, 0.0, 5);
  const BodyId robot = small.add(GetParam().robot(), at(1, 0, 0));
  const BodyId dropped = small.add(small_box(), at(2, 0, 1.3));  // falls for half a second
  small.run(0.4);
  EXPECT_TRUE(none_sleeps(small, stack));
  small.run(5.0);
  EXPECT_TRUE(all_sleep(small, stack));
  EXPECT_TRUE(all_sleep(small, {robot, dropped}));
  EXPECT_EQ(small.velocity(stack[4]), Eigen::Vector3d::Zero());
  EXPECT_GT(small.world().contacts().size(), 5u * 4u) << "what presses on what is still told";
}

TEST_P(Sleeping, IsPartOfTheHashAndOfSnapshots) {
  SmallWorld small = floor();
  const auto stack = add_stack(small, 0.0, 3);
  small.run(3.0);
  ASSERT_TRUE(all_sleep(small, stack));
  const std::uint64_t asleep = hash_of(small.world());
  small.run(10.0);
  EXPECT_EQ(hash_of(small.world()), asleep) << "nothing changes";

  WorkerPool workers(3);
  const auto restored = physics::make_world(small.description, workers);
  restore_from(small.world(), *restored);
  EXPECT_EQ(hash_of(*restored), asleep);
  for (physics::World* world : {&small.world(), restored.get()}) {
    world->push_body(stack[1], LinkId{0}, {{3, 0, 0}, {0, 0, 0}});
    for (int i = 0; i < 20; ++i) world->step();
  }
  EXPECT_FALSE(small.world().is_asleep(stack[0]));
  EXPECT_NE(hash_of(small.world()), asleep);
  EXPECT_EQ(hash_of(*restored), hash_of(small.world()));
}

// A ball rolls into one of two stacks.
TEST_P(Sleeping, AnImpactWakesOnlyItsIslandWithTheSameBits) {
  const auto end_of = [&](bool sleeping, bool other_stack, unsigned threads) {
    description::World world = GetParam().world();
    world.physics.sleeping = sleeping;
    SmallWorld small(world, threads);
    const auto stack = add_stack(small, 0.0, 3, 0.3);
    const BodyId ball = small.add(loose("ball", description::Sphere{0.05}, solid_sphere(1.0, 0.05)), at(-2.0, 0, 0.05));
    const auto far = other_stack ? add_stack(small, 3.0, 3) : std::vector<BodyId>{};
    small.world().set_root_twist(ball, {{0, 20, 0}, {1.0, 0, 0}});
    small.run(1.7);
    EXPECT_EQ(small.world().is_asleep(stack[0]), sleeping);
    small.run(0.5);  // the ball arrives after 0.2 s
    EXPECT_TRUE(none_sleeps(small, stack));
    EXPECT_EQ(all_sleep(small, far), sleeping || far.empty());
    std::vector<Eigen::Vector3d> places;
    places.reserve(stack.size());
    for (const BodyId body : stack) places.push_back(small.position(body));
    return std::pair(places, hash_of(small.world(), std::vector{stack[0], stack[1], stack[2], ball}));
  };
  const auto [asleep, hash] = end_of(true, false, 1);
  const auto [awake, other_hash] = end_of(false, false, 1);
  EXPECT_GT(asleep[0].x(), 0.005) << "it was hit";
  for (std::size_t i = 0; i < asleep.size(); ++i) EXPECT_LT((asleep[i] - awake[i]).norm(), 1e-4) << i;
  EXPECT_EQ(end_of(true, true, 1).second, hash) << "whatever sleeps elsewhere";
  EXPECT_EQ(end_of(true, true, 4).second, hash) << "with any number of threads";
}

TEST_P(Sleeping, EveryExternalChangeWakes) {
  const auto wakes = [&](const std::function<void(SmallWorld&)>& change) {
    SmallWorld small = floor();
    small.add(small_box(), at(0, 0, 0.05));      // 1
    small.add(small_box(), at(0, 0, 0.15));      // 2, on it
    small.add(GetParam().robot(), at(1, 0, 0));  // 3
    small.add(small_box(), at(2, 0, 0.05));      // 4
    small.run(3.0);
    EXPECT_TRUE(all_sleep(small, {BodyId{1}, BodyId{2}, BodyId{3}, BodyId{4}}));
    change(small);
    small.world().step();
    std::string awake;
    for (const BodyId body : {BodyId{1}, BodyId{2}, BodyId{3}, BodyId{4}})
      if (small.world().activity(body) == physics::Activity::awake) awake += std::to_string(body.value);
    return awake;
  };
  EXPECT_EQ(wakes([](SmallWorld&) {}), "");
  EXPECT_EQ(wakes([](SmallWorld& small) {
              small.world().push_body(BodyId{2}, LinkId{0}, {{0, 0, 1}, {0, 0, 0}});
            }),
            "12");
  EXPECT_EQ(wakes([](SmallWorld& small) { small.world().set_root_twist(BodyId{4}, {{0, 0, 0}, {0.1, 0, 0}}); }), "4");
  EXPECT_EQ(wakes([](SmallWorld& small) { small.world().set_present(BodyId{1}, false); }), "2");
  EXPECT_EQ(wakes([](SmallWorld& small) { small.world().place_body(BodyId{2}, at(-1, 0, 0.05)); }), "12");
  EXPECT_EQ(wakes([](SmallWorld& small) { small.world().place_body(BodyId{4}, at(0, 0.09, 0.25)); }), "124");
  EXPECT_EQ(wakes([](SmallWorld& small) { small.drive(BodyId{3}, 0.1, 0.1); }), "3");
  EXPECT_EQ(wakes([](SmallWorld& small) { small.drive(BodyId{3}, 0.0, 0.0); }), "") << "that is what it does already";
  EXPECT_EQ(wakes([](SmallWorld& small) {
              small.world().set_joint_target(BodyId{3}, JointId{0}, physics::JointTarget::velocity(0.5));
            }),
            "3");
  EXPECT_EQ(wakes([](SmallWorld& small) {
              small.world().connections().connect({BodyId{4}, LinkId{0}}, {}, {BodyId{2}, LinkId{0}});
            }),
            "124");
  EXPECT_EQ(wakes([](SmallWorld& small) { small.world().record(BodyId{4}); }), "4");
  EXPECT_EQ(wakes([](SmallWorld& small) { small.world().set_present(BodyId{0}, false); }), "1234") << "the floor";
  EXPECT_EQ(wakes([](SmallWorld& small) { small.world().add_body(1, at(2, 0, 0.15)); }), "4") << "it comes to lie on 4";
}

TEST_P(Sleeping, ABodyFallsWhenItsSupportIsRemoved) {
  SmallWorld small = floor();
  const BodyId table = small.add(static_shape("table", description::Box{{1, 1, 0.1}}), at(0, 0, 0.95));
  const BodyId box = small.add(small_box(), at(0, 0, 1.05));
  small.run(2.0);
  ASSERT_TRUE(small.world().is_asleep(box));
  small.world().place_body(table, at(5, 0, 0.95));
  small.run(2.0);
  EXPECT_NEAR(small.position(box).z(), 0.05, 1e-4);
  EXPECT_TRUE(small.world().is_asleep(box));
}

TEST_P(Sleeping, ASleepingBodyFallsWhenItsConnectionIsReleased) {
  SmallWorld small = floor();
  const BodyId post = small.add(static_shape("post", description::Box{{0.1, 0.1, 2}}), at(0, 0, 1));
  const BodyId hanging = small.add(small_box(), at(0.12, 0, 1));
  const ConnectionId bond = small.world().connections().connect({hanging, LinkId{0}}, {}, {post, LinkId{0}});
  small.run(3.0);
  EXPECT_TRUE(small.world().is_asleep(hanging));
  EXPECT_NEAR(small.world().connections().wrench(bond).force_W.z(), g, 1e-4) << "it is still borne";
  small.world().connections().disconnect(bond);
  small.run(2.0);
  EXPECT_NEAR(small.position(hanging).z(), 0.05, 1e-4);
}

TEST_P(Sleeping, ARobotOnABoardSleepsAndDrivesOffWithIt) {
  SmallWorld small = floor();
  const Eigen::Vector3d size(0.5, 0.5, 0.01);
  const description::Surface slippery{0.01, 0.0};
  const BodyId board =
      small.add(loose("board", description::Box{size}, solid_box(0.2, size), slippery), at(0, 0, 0.005));
  const BodyId robot = small.add(GetParam().robot(), at(0, 0, 0.01));
  small.run(3.0);
  ASSERT_TRUE(all_sleep(small, {board, robot}));
  WorkerPool workers(2);
  const auto restored = physics::make_world(small.description, workers);
  restore_from(small.world(), *restored);
  for (physics::World* world : {&small.world(), restored.get()}) {
    for (const std::size_t side : {0, 1}) world->set_device_target(robot, DeviceId{0}, side, 0.1);
    for (int i = 0; i < 50; ++i) world->step();
  }
  EXPECT_FALSE(small.world().is_asleep(board));
  EXPECT_GT(std::abs(small.position(robot).x()), 0.01);
  EXPECT_EQ(hash_of(*restored), hash_of(small.world())) << "what it stands on is known after restoring too";
}

TEST_P(Sleeping, SlowBodiesStayAwake) {
  SmallWorld small = floor();
  const BodyId slow = small.add(GetParam().robot(), at(0, 0, 0));
  small.drive(slow, 1e-4, 1e-4);
  small.run(20.0);
  EXPECT_NEAR(std::abs(small.position(slow).x()), 20.0 * 1e-4, 1e-4);
  EXPECT_FALSE(small.world().is_asleep(slow));
}

TEST_P(Sleeping, ModelsAndWorldsMayDisableSleep) {
  SmallWorld small = floor();
  description::Model insomniac = small_box();
  insomniac.name = "insomniac";
  insomniac.may_sleep = false;
  const BodyId lower = small.add(small_box(), at(0, 0, 0.05));
  const BodyId upper = small.add(insomniac, at(0, 0, 0.15));
  const BodyId other = small.add(small_box(), at(1, 0, 0.05));
  SmallWorld awake = floor(false);
  const BodyId box = awake.add(small_box(), at(0, 0, 0.05));
  small.run(2.0);
  awake.run(2.0);
  EXPECT_TRUE(none_sleeps(small, {lower, upper}));
  EXPECT_TRUE(small.world().is_asleep(other));
  EXPECT_FALSE(awake.world().is_asleep(box));
}

// Returns the median CPU time of a step, in this thread.
double cost_of_step(SmallWorld& small) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  std::vector<double> costs;
  for (int i = 0; i < 11; ++i) {
    const double begin = now();
    small.world().step();
    costs.push_back(now() - begin);
  }
  std::ranges::nth_element(costs, costs.begin() + 5);
  return costs[5];
}

TEST_P(Sleeping, TenThousandSleepingBoxesCostATwentieth) {
  const auto cost = [&](bool sleeping, bool one_is_awake) {
    SmallWorld small = floor(sleeping);
    const description::Model box = small_box();
    for (int i = 0; i < 10'000; ++i) {
      const int row = i / 100;
      small.add(box, at(0.2 * (i % 100), 0.2 * row, 0.05));
    }
    description::Model insomniac = box;
    insomniac.name = "insomniac";
    insomniac.may_sleep = false;
    if (one_is_awake) small.add(insomniac, at(-1, 0, 0.05));
    small.run(sleeping ? 1.0 : 0.1);
    return cost_of_step(small);
  };
  const double awake = cost(false, false);
  const double asleep = cost(true, false);
  const double beside_one = cost(true, true);
  RecordProperty("asleep", std::to_string(asleep / awake));
  RecordProperty("beside_one", std::to_string(beside_one / awake));
  EXPECT_LT(asleep, 0.05 * awake);
  EXPECT_LT(beside_one, 0.05 * awake);
}

}  // namespace
}  // namespace cohort::test
