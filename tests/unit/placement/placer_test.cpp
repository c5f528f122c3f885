// SPDX-License-Identifier: Apache-2.0
#include "server/placement/placer.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>
#include <set>
#include <thread>
#include <vector>

#include "server/geometry/shapes/footprint.hpp"
#include "server/placement/place.hpp"
#include "server/placement/with_seed.hpp"
#include "tests/support/worlds/arena_of_obstacles.hpp"
#include "tests/support/worlds/experiment_text.hpp"

// Tests placement alone, without libsdformat and file readers.
namespace cohort::placement {
namespace {

World placed_arena(std::uint64_t seed) {
  World world = test::arena_of_obstacles(test::Obstacles::drawn);
  std::set<std::string> names;
  std::vector<Problem> problems;
  add_populations(world, seed, names, problems);
  set_robots(world);
  check_instances(world, problems);
  EXPECT_TRUE(problems.empty());
  return world;
}

Experiment experiment_in(World world, std::uint64_t seed) {
  Experiment experiment;
  experiment.world = std::move(world);
  experiment.seed = seed;
  return experiment;
}

/// Prevents opening files during its lifetime.
class NoMoreFiles {
 public:
  NoMoreFiles() {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{0, before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
  }
  NoMoreFiles(const NoMoreFiles&) = delete;
  NoMoreFiles& operator=(const NoMoreFiles&) = delete;
  ~NoMoreFiles() { setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

TEST(Placing, GivesWhatMakingTheWorldWithThatSeedGivesAndOpensNoFile) {
  const Experiment first = experiment_in(placed_arena(1), 1);
  ASSERT_EQ(first.world.instances.size(), 30u);
  EXPECT_EQ(first.world.instances[5].name, "posts/post_0");
  EXPECT_EQ(first.world.instances[29].name, "robots/robot_0");
  const NoMoreFiles limit;
  ASSERT_FALSE(std::ifstream("/proc/self/maps").is_open());
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::string expected = test::text_of(experiment_in(placed_arena(seed), seed));
    EXPECT_EQ(test::text_of(with_seed(first, seed)), expected);
    EXPECT_EQ(test::text_of(with_seed(with_seed(first, 77), seed)), expected);
  }
  EXPECT_NE(with_seed(first, 2).world.instances[29].X_WM.position, first.world.instances[29].X_WM.position);
}

TEST(Placing, LeavesTheGapToWhatEarlierPopulationsHavePutThere) {
  const Placer placer(placed_arena(1));
  std::vector<Pose> poses(placer.count());
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    ASSERT_TRUE(placer.place(seed, poses));
    for (std::size_t post = 0; post < 24; ++post) {
      const auto footprint = geometry::footprint_of(Box{{0.2, 0.1, 0.2}}, poses[post]);
      EXPECT_GE(footprint->distance(poses[24].position.head<2>()), 0.058 + 0.02 - 1e-9) << seed;
    }
  }
}

TEST(Placing, IsTheSameFromManyThreadsWithOnePlacer) {
  constexpr std::uint64_t seeds = 200;
  const World world = placed_arena(1);
  const Placer placer(world);
  ASSERT_EQ(placer.first(), 5u);
  ASSERT_EQ(placer.count(), 25u);
  const auto place_all = [&](std::vector<Pose>& poses) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed)
      ASSERT_TRUE(placer.place(seed, std::span(poses).subspan(seed * placer.count(), placer.count())));
  };
  std::vector<std::vector<Pose>> poses(4, std::vector<Pose>(seeds * placer.count()));
  std::vector<std::thread> threads;
  for (std::vector<Pose>& each : poses) threads.emplace_back([&] { place_all(each); });
  for (std::thread& thread : threads) thread.join();
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const World expected = with_seed(experiment_in(world, 1), seed).world;
    for (const std::vector<Pose>& each : poses)
      for (std::size_t i = 0; i < placer.count(); ++i) {
        const Pose& X_WM = expected.instances[placer.first() + i].X_WM;
        ASSERT_EQ(each[seed * placer.count() + i].position, X_WM.position);
        ASSERT_EQ(each[seed * placer.count() + i].orientation.coeffs(), X_WM.orientation.coeffs());
      }
  }
}

TEST(Placing, SaysWhichPopulationHasNoRoomAndWhereItIsWritten) {
  World world = placed_arena(1);
  world.populations[0].gap = 0.6;
  world.populations[0].placement_place = {"w.sdf", 7, "world/cohort:population[posts]/cohort:placement", ""};
  std::vector<Pose> poses(25);
  try {
    Placer(world).place(2, poses);
    FAIL() << "posts that need more room than there is were placed";
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 1u);
    EXPECT_EQ(error.problems()[0].file, "w.sdf");
    EXPECT_EQ(error.problems()[0].line, 7);
    EXPECT_NE(error.problems()[0].message.find(" of 24 fit; enlarge the area"), std::string::npos) << error.what();
  }
  EXPECT_THROW(with_seed(experiment_in(world, 1), 2), InputError);
}

TEST(Placing, TellsASeedThatGivesOtherInstances) {
  World world = placed_arena(1);
  world.populations[0].gap = 0.5;
  world.populations[0].may_be_fewer = true;
  std::vector<Pose> poses(25);
  EXPECT_FALSE(Placer(world).place(2, poses));
  // This experiment cannot select its robots again.
  EXPECT_THROW(with_seed(experiment_in(world, 1), 2), InputError);
}

TEST(Placing, OfAWorldWithoutPopulationsChangesTheSeedAlone) {
  World world = placed_arena(1);
  world.populations.clear();
  const Experiment other = with_seed(experiment_in(world, 1), 2);
  EXPECT_EQ(test::text_of(other), test::text_of(experiment_in(world, 2)));
}

}  // namespace
}  // namespace cohort::placement
