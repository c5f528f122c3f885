// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/core/random.hpp"
#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using Eigen::Vector3d;

// Robots in a row, each turret connected to the one before.
struct Chain {
  static constexpr double spacing = 0.13;
  SmallWorld small;
  std::vector<BodyId> robots;
  std::vector<ConnectionId> connections;

  Chain(const Physics& physics, int count, const physics::ConnectionLimits& limits = {}) : small(physics.world()) {
    for (int i = 0; i < count; ++i) robots.push_back(small.add(physics.robot(), at(spacing * i, 0, 0)));
    for (std::size_t i = 1; i < robots.size(); ++i)
      connections.push_back(small.world().connections().connect(
          {robots[i - 1], LinkId{turret}}, {{0.5 * spacing, 0, 0.02}}, {robots[i], LinkId{turret}}, limits));
  }

  // Returns the greatest distance between the two ends of a connection [m].
  double gap() {
    double greatest = 0.0;
    for (std::size_t i = 1; i < robots.size(); ++i) {
      const Vector3d a = small.world().link_pose(robots[i - 1], LinkId{turret}) * Vector3d(0.5 * spacing, 0, 0.02);
      const Vector3d b = small.world().link_pose(robots[i], LinkId{turret}) * Vector3d(-0.5 * spacing, 0, 0.02);
      greatest = std::max(greatest, (a - b).norm());
    }
    return greatest;
  }
  void drive_at_random(int tick) {
    const RandomStream random(1, "chain", "drive");
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const auto draw = static_cast<std::uint32_t>(3 * i);
      small.drive(robots[i], 0.4 * random.uniform(tick / 20, draw) - 0.2,
                  0.4 * random.uniform(tick / 20, draw + 1) - 0.2);
      small.world().set_joint_target(robots[i], JointId{0},
                                     physics::JointTarget::velocity(2.0 * random.uniform(tick / 20, draw + 2) - 1.0));
    }
  }
};

class Formations : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, Formations, every_physics, name_of);

TEST_P(Formations, AChainOf25StaysWithinTwoMillimetresUnderLoad) {
  Chain chain(GetParam(), 25);
  for (int tick = 0; tick < 1000; ++tick) {
    chain.drive_at_random(tick);
    chain.small.world().step();
    ASSERT_LT(chain.gap(), 2e-3) << "at tick " << tick;
  }
  for (const BodyId robot : chain.robots) EXPECT_GT(chain.small.up(robot).z(), 0.99);
}

TEST_P(Formations, AnIslandOf128HoldsTogether) {
  Chain chain(GetParam(), 128);
  for (int tick = 0; tick < 300; ++tick) {
    chain.drive_at_random(tick);
    chain.small.world().step();
  }
  EXPECT_LT(chain.gap(), 3e-3);
}

TEST_P(Formations, AConnectionReportsItsForce) {
  Chain chain(GetParam(), 2);
  // One pulls with full force; the other is connected to the world.
  const auto held = chain.small.world().connections().connect({chain.robots[0], LinkId{0}}, {}, {BodyId{0}, LinkId{0}});
  chain.small.drive(chain.robots[1], 0.2, 0.2);
  chain.small.run(2.0);
  const double pull = 2.0 * 0.02 / 0.022;  // both motors' torque over the radius of the wheels
  EXPECT_NEAR(chain.small.world().connections().wrench(chain.connections[0]).force_W.x(), pull, 0.01);
  // The world holds the other, and so do its own tracks, which are commanded to stand still.
  double own = 0.0;
  for (const std::size_t side : {0, 1})
    own += chain.small.world().device_state(chain.robots[0], DeviceId{0}, side).effort;
  EXPECT_NEAR(chain.small.world().connections().wrench(held).force_W.x() + own, -pull, 0.01);
}

TEST_P(Formations, AConnectionBreaksAtItsLimit) {
  Chain chain(GetParam(), 3, {.force = 1.0});
  chain.small.drive(chain.robots[0], -0.2, -0.2);
  chain.small.drive(chain.robots[2], 0.2, 0.2);
  std::vector<ConnectionId> broken;
  for (int tick = 0; tick < 200; ++tick) {
    chain.small.world().step();
    const auto now = chain.small.world().connections().broken();
    broken.insert(broken.end(), now.begin(), now.end());
  }
  EXPECT_FALSE(broken.empty());
  for (const ConnectionId connection : broken) EXPECT_FALSE(chain.small.world().connections().holds(connection));
  EXPECT_GT(chain.gap(), 0.1);
}

TEST_P(Formations, TwoRobotsDriveApartAfterARelease) {
  Chain chain(GetParam(), 2);
  chain.small.run(0.5);
  chain.small.world().connections().disconnect(chain.connections[0]);
  chain.small.drive(chain.robots[0], -0.1, -0.1);
  chain.small.drive(chain.robots[1], 0.1, 0.1);
  chain.small.run(2.0);
  EXPECT_NEAR(chain.gap(), 0.4, 0.03);
}

TEST_P(Formations, AConnectionToARemovedOrMovedWallIsReleased) {
  for (const bool is_moved : {false, true}) {
    SmallWorld small(GetParam().world());
    const BodyId wall = small.add(static_shape("wall", description::Box{{0.1, 1, 1}}), at(0.5, 0, 0.5));
    const BodyId robot = small.add(GetParam().robot(), at(0, 0, 0));
    const ConnectionId connection = small.world().connections().connect({robot, LinkId{0}}, {}, {wall, LinkId{0}});
    small.drive(robot, -0.1, -0.1);
    small.run(0.5);
    EXPECT_NEAR(small.position(robot).x(), 0.0, 0.01);
    if (is_moved)
      small.world().place_body(wall, at(0.6, 0, 0.5));
    else
      small.world().set_present(wall, false);
    EXPECT_FALSE(small.world().connections().holds(connection));
    small.run(1.0);
    EXPECT_LT(small.position(robot).x(), -0.05);
  }
}

// The same chain with each solver: all hold it together.
class EverySolver : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, EverySolver,
                         ::testing::Values(treel, by_bullet(treel), direct, by_bullet(direct), hybrid,
                                           by_bullet(iterative)),
                         name_of);

TEST_P(EverySolver, HoldsAChainOfFour) {
  Chain chain(GetParam(), 4);
  for (int tick = 0; tick < 300; ++tick) {
    chain.drive_at_random(tick);
    chain.small.world().step();
    ASSERT_LT(chain.gap(), 2e-3) << "at tick " << tick;
  }
}

}  // namespace
}  // namespace cohort::test
