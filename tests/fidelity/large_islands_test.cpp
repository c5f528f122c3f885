// SPDX-License-Identifier: Apache-2.0

// Large islands, which are cut into parts and solved by all workers at once.

#include <gtest/gtest.h>

#include <algorithm>

#include "server/core/random.hpp"
#include "server/physics/islands/island_parts.hpp"
#include "server/physics/islands/large_island_solver.hpp"
#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using Eigen::Vector3d;
using physics::IslandParts;

// Robots that drive at random.
struct DrivenRobots {
  DrivenRobots(const Physics& physics, unsigned threads) : small(physics.world(), threads) {}

  SmallWorld small;
  std::vector<BodyId> robots;

  std::uint64_t run(int ticks) {
    const RandomStream random(1, "island", "drive");
    for (int tick = 0; tick < ticks; ++tick) {
      for (const BodyId robot : robots)
        small.drive(robot, 0.4 * random.uniform(tick / 10, 2 * robot.value) - 0.2,
                    0.4 * random.uniform(tick / 10, 2 * robot.value + 1) - 0.2);
      small.world().step();
    }
    return hash_of(small.world());
  }
};

// Robots in a square, each connected to the previous one in its row and in its column.
struct Raft : DrivenRobots {
  static constexpr double spacing = 0.13;

  Raft(const Physics& physics, int edge, unsigned threads) : DrivenRobots(physics, threads) {
    for (int y = 0; y < edge; ++y)
      for (int x = 0; x < edge; ++x) robots.push_back(small.add(physics.robot(), at(spacing * x, spacing * y, 0)));
    const auto robot = [&](int x, int y) {
      return robots[static_cast<std::size_t>(y) * static_cast<std::size_t>(edge) + static_cast<std::size_t>(x)];
    };
    for (int y = 0; y < edge; ++y) {
      for (int x = 0; x < edge; ++x) {
        if (x > 0)
          small.world().connections().connect({robot(x, y), LinkId{turret}}, {{-0.5 * spacing, 0, 0.02}},
                                              {robot(x - 1, y), LinkId{turret}});
        if (y > 0)
          small.world().connections().connect({robot(x, y), LinkId{turret}}, {{0, -0.5 * spacing, 0.02}},
                                              {robot(x, y - 1), LinkId{turret}});
      }
    }
  }
};

// A loose board with robots that drive on it and push each other; some stand half on it, half on the floor.
struct CrowdedBoard : DrivenRobots {
  BodyId board;

  CrowdedBoard(const Physics& physics, unsigned threads) : DrivenRobots(physics, threads) {
    const Vector3d size(1.6, 1.6, 0.01);
    board = small.add(loose("board", description::Box{size}, solid_box(5.0, size)), at(0.72, 0.72, 0.005));
    for (int y = 0; y < 11; ++y)
      for (int x = 0; x < 11; ++x)
        robots.push_back(small.add(physics.robot(), at(0.145 * x - 0.06, 0.145 * y, x == 0 ? 0.006 : 0.01)));
  }
};

class LargeIslands : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, LargeIslands,
                         ::testing::Values(articulated, by_bullet(articulated), treel, by_bullet(treel)), name_of);

TEST_P(LargeIslands, HaveTheSameBitsForAnyNumberOfThreads) {
  const std::uint64_t expected = Raft(GetParam(), 12, 1).run(60);
  for (const unsigned threads : {2u, 3u}) EXPECT_EQ(Raft(GetParam(), 12, threads).run(60), expected) << threads;
}

TEST_P(LargeIslands, OnAMovingBoardHaveTheSameBitsForAnyNumberOfThreads) {
  CrowdedBoard one(GetParam(), 1);
  const std::uint64_t expected = one.run(100);
  EXPECT_NEAR(one.small.position(one.board).z(), 0.005, 1e-4);
  for (const BodyId robot : one.robots) EXPECT_GT(one.small.up(robot).z(), 0.95);
  for (const unsigned threads : {2u, 3u}) EXPECT_EQ(CrowdedBoard(GetParam(), threads).run(100), expected) << threads;
}

TEST_P(LargeIslands, HoldTogetherLikeSmallOnes) {
  Raft raft(GetParam(), 12, 2);
  raft.run(200);
  for (std::size_t i = 1; i < raft.robots.size(); ++i) {
    if (i % 12 == 0) continue;
    const double distance =
        (raft.small.position(raft.robots[i], turret) - raft.small.position(raft.robots[i - 1], turret)).norm();
    EXPECT_NEAR(distance, Raft::spacing, 2e-3) << i;
  }
  for (const BodyId robot : raft.robots) EXPECT_GT(raft.small.up(robot).z(), 0.99);
}

TEST_P(LargeIslands, ContinueWithoutABodyThatBreaks) {
  const auto broken_run = [](unsigned threads) {
    Raft raft(GetParam(), 11, threads);
    raft.run(10);
    const BodyId broken = raft.robots[60];
    raft.small.world().set_root_twist(broken, {Vector3d::Zero(), Vector3d(1e9, 0, 0)});
    raft.small.world().step();
    EXPECT_EQ(raft.small.world().quarantined().size(), 1u);
    EXPECT_FALSE(raft.small.world().is_active(broken));
    const std::uint64_t hash = raft.run(50);
    for (const BodyId robot : raft.robots) {
      if (robot != broken) {
        EXPECT_GT(raft.small.up(robot).z(), 0.99);
      }
    }
    return hash;
  };
  EXPECT_EQ(broken_run(1), broken_run(4));
}

// A hundred balls that hit a board at once are one island.
TEST_P(LargeIslands, BounceToTheHeightOfTheirRestitution) {
  SmallWorld small(GetParam().world());
  const Vector3d size(2.2, 2.2, 0.02);
  small.add(loose("board", description::Box{size}, solid_box(1000.0, size), {1.0, 1.0}), at(1.0, 1.0, 0.01));
  std::vector<BodyId> balls;
  const description::Model ball =
      loose("ball", description::Sphere{0.05}, description::solid_sphere(0.001, 0.05), {1.0, 0.8});
  balls.reserve(100);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x) balls.push_back(small.add(ball, at(0.2 * x, 0.2 * y, 0.02 + 0.05 + 0.31)));
  small.run(0.3);  // they hit after 0.25 s
  std::vector<double> peaks(balls.size(), 0.0);
  for (int i = 0; i < 40; ++i) {
    small.world().step();
    for (std::size_t each = 0; each < balls.size(); ++each)
      peaks[each] = std::max(peaks[each], small.position(balls[each]).z() - 0.07);
  }
  for (const double peak : peaks) EXPECT_NEAR(peak, 0.64 * 0.31, 0.002);
}

// A hundred bodies in a row, of which every third is linked to one far away.
void link_all(IslandParts& parts, std::uint32_t count) {
  parts.reset(count);
  for (std::uint32_t body = 1; body < count; ++body) parts.link(body - 1, body);
  for (std::uint32_t body = 0; body + 50 < count; body += 3) parts.link(body, body + 50);
}

TEST(IslandParts, ContainEveryBodyOnceAndAreFullExceptTheLast) {
  IslandParts parts;
  link_all(parts, 100);
  parts.cut(16);
  std::vector<int> seen(100, 0);
  for (std::uint32_t part = 0; part < parts.count(); ++part) {
    EXPECT_EQ(parts.bodies(part).size(), part + 1 < parts.count() ? 16u : 4u);
    for (const std::uint32_t body : parts.bodies(part)) {
      ++seen[body];
      EXPECT_EQ(parts.part_of(body), part);
    }
    EXPECT_TRUE(std::is_sorted(parts.bodies(part).begin(), parts.bodies(part).end()));
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 100);
}

TEST(IslandParts, OfARowAreContiguous) {
  IslandParts parts;
  parts.reset(96);
  for (std::uint32_t body = 1; body < 96; ++body) parts.link(body, body - 1);
  parts.cut(32);
  ASSERT_EQ(parts.count(), 3u);
  for (std::uint32_t body = 0; body < 96; ++body) EXPECT_EQ(parts.part_of(body), body / 32);
}

TEST(IslandParts, OfAStarAreFull) {
  IslandParts parts;
  parts.reset(200);
  for (std::uint32_t body = 1; body < 200; ++body) parts.link(0, body);
  parts.cut(32);
  EXPECT_EQ(parts.count(), 7u);
}

}  // namespace
}  // namespace cohort::test
